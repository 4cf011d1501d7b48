// SPDX-License-Identifier: MIT
// Quincunx in an engine that nobody here wrote: OpenSceneGraph 3.6 draws a model of any format that it reads.
//
//   openscenegraph MODEL [WIDTH HEIGHT]                        in a window; the mouse turns it
//   openscenegraph MODEL WIDTH HEIGHT FRAMES PICTURE.png [SCALE METHOD]
//                          a slow turn, the last frame as a file; at a fixed scale, by temporal or bilinear
#include <quincunx/control/predictive_controller.h>
#include <quincunx/resolve_service.h>
#include <quincunx_gl/bridge.h>
// After epoxy, which has OpenGL's names.
#include <osg/TexEnvFilter>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>

using namespace quincunx;

constexpr int kTextureUnits = 4;  // whose textures get the bias

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

template <typename T>
T get(Result<T> result) {
  if (!result.ok()) fail(result.status().message());
  return std::move(result).value();
}

osg::ref_ptr<osg::Texture2D> make_texture(GLint internal, GLenum format, GLenum type, Extent extent) {
  osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
  texture->setTextureSize(extent.width, extent.height);
  texture->setInternalFormat(internal);
  texture->setSourceFormat(format);
  texture->setSourceType(type);
  texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
  texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
  return texture;
}

// Runs when the engine has drawn a frame, with its context current.
struct AfterDrawing : osg::Camera::DrawCallback {
  explicit AfterDrawing(std::function<void(unsigned)> callback) : what(std::move(callback)) {}
  void operator()(osg::RenderInfo& info) const override { what(info.getContextID()); }
  std::function<void(unsigned)> what;
};

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4 && argc != 6 && argc != 8)
    fail("openscenegraph MODEL [WIDTH HEIGHT [FRAMES PICTURE.png [SCALE METHOD]]]");
  const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(argv[1]);
  if (!model) fail(std::string("OpenSceneGraph reads no model from '") + argv[1] + "'");
  const Extent output = argc > 2 ? Extent{std::atoi(argv[2]), std::atoi(argv[3])} : Extent{960, 540};
  const long frames = argc > 4 ? std::atol(argv[4]) : 0;  // 0: until the window is closed
  const bool fixed = argc > 6;
  const double scale = fixed ? std::atof(argv[6]) : 0.5;  // at least

  // What the engine's textures mean. Its colours are made for the screen, not linear.
  ResolveSettings settings;
  settings.output_extent = settings.target_extent = output;
  settings.colour = PixelFormat::kRGBA8;
  settings.conventions = {
      .depth = DepthConvention::kForward, .clip_space = ClipSpace::kOpenGl, .origin = Origin::kBottom};
  if (fixed && argv[7] == std::string("bilinear")) settings.method = Method::kBilinear;
  // Velocity comes from depth and camera.
  const SceneNeeds needs = {.moving_objects = false, .transparents = false};
  gl::BridgeSettings bridging = gl::bridge_settings(get(plan_for(needs, settings)));
  bridging.imports = true;

  // The engine: a window, and a camera that draws into textures instead.
  osgViewer::Viewer viewer;
  viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
  viewer.setSceneData(model);
  osg::Camera* const camera = viewer.getCamera();
  const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
  traits->readDISPLAY();
  traits->setUndefinedScreenDetailsToDefaultScreen();
  traits->width = output.width;
  traits->height = output.height;
  traits->windowName = "Quincunx";
  traits->windowDecoration = traits->doubleBuffer = true;
  traits->supportsResize = false;
  const osg::ref_ptr<osg::GraphicsContext> window = osg::GraphicsContext::createGraphicsContext(traits);
  if (!window) fail("OpenSceneGraph finds no display");
  camera->setGraphicsContext(window);
  if (frames == 0) viewer.setCameraManipulator(new osgGA::TrackballManipulator);
  viewer.realize();
  window->makeCurrent();

  // What makes the picture.
  const auto context = get(gl::Context::create(gl::Platform::kCurrent));
  const auto device = get(gl::open_device(context, "", gl::Interop::kAuto));
  const auto bridge = get(gl::Bridge::create(context, device, bridging));
  settings.targets.storage = bridge->storage();
  auto service = get(ResolveService::create(device, get(plan_for(needs, settings))));
  const auto controller = get(make_predictive_controller(
      {.ladder = {.output_extent = output, .min_scale = scale, .max_scale = fixed ? scale : 1}}));

  const auto colour = make_texture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, output);
  const auto depth = make_texture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, output);
  camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
  camera->attach(osg::Camera::COLOR_BUFFER, colour);
  camera->attach(osg::Camera::DEPTH_BUFFER, depth);
  camera->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);  // they are told to the service
  camera->setProjectionResizePolicy(osg::Camera::FIXED);
  camera->setClearColor({0.2f, 0.25f, 0.35f, 1});
  const osg::ref_ptr<osg::TexEnvFilter> bias = new osg::TexEnvFilter;
  for (unsigned unit = 0; unit < kTextureUnits; ++unit)
    camera->getOrCreateStateSet()->setTextureAttribute(unit, bias);

  GLuint picture = 0, framebuffer = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &picture);
  glTextureStorage2D(picture, 1, GL_RGBA8, output.width, output.height);
  glCreateFramebuffers(1, &framebuffer);
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, picture, 0);

  FrameInputs frame;
  camera->setFinalDrawCallback(new AfterDrawing([&](unsigned id) {
    const gl::FrameTextures textures = {.colour = colour->getTextureObject(id)->id(),
                                        .depth = depth->getTextureObject(id)->id()};
    const gl::SharedFrame inputs = get(bridge->import(textures, frame.render_extent));
    frame.colour = inputs.colour;
    frame.depth = inputs.depth;
    const FrameReport report = service.dispatch(frame, {.presented = get(bridge->begin_present())});
    if (!report.ok()) fail(report.status.message());
    if (const Status status = bridge->present(picture); !status.ok()) fail(status.message());
    glBlitNamedFramebuffer(framebuffer, 0, 0, 0, output.width, output.height, 0, 0, output.width,
                           output.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }));

  const osg::BoundingSphere bound = model->getBound();
  const double aspect = static_cast<double>(output.width) / output.height;
  osg::Matrixd previous;
  for (long n = 0; !viewer.done() && (n != frames || frames == 0); ++n) {
    const auto begun = std::chrono::steady_clock::now();
    const Extent render = controller->next();
    viewer.advance();
    viewer.eventTraversal();
    viewer.updateTraversal();
    if (frames > 0) {
      const double angle = 0.5 + 0.005 * static_cast<double>(n);
      const osg::Vec3d away(std::sin(angle), -std::cos(angle), 0.15);
      camera->setViewMatrixAsLookAt(bound.center() + away * (1.7 * bound.radius()), bound.center(),
                                    {0, 0, 1});
    }
    const osg::Matrixd view = camera->getViewMatrix();
    const double distance = -(osg::Vec3d(bound.center()) * view).z();
    const double near_plane = std::max(distance - bound.radius(), 0.01 * bound.radius());
    const double far_plane = std::max(distance + bound.radius(), 2 * near_plane);
    const auto projection = osg::Matrixd::perspective(45, aspect, near_plane, far_plane);

    frame.render_extent = render;
    frame.frame_index = static_cast<std::uint64_t>(n);
    frame.near_plane = static_cast<float>(near_plane);
    frame.far_plane = static_cast<float>(far_plane);
    if (uses_earlier_frames(settings.method)) {  // filters of one frame need neither
      frame.jitter = jitter(frame.frame_index, render, output);
      bias->setLodBias(texture_lod_bias(render, output));
    }
    // The engine's vectors are rows; in memory its matrices are the same.
    if (n > 0) {
      const osg::Matrixf motion(osg::Matrixd::inverse(view * projection) * previous);
      std::copy_n(motion.ptr(), 16, frame.camera.clip_to_previous_clip.begin());
    }
    previous = view * projection;
    camera->setProjectionMatrix(projection * osg::Matrixd::translate(-2.0 * frame.jitter.x / render.width,
                                                                     -2.0 * frame.jitter.y / render.height,
                                                                     0));
    camera->setViewport(0, 0, render.width, render.height);
    viewer.renderingTraversals();

    // present() has waited for OpenCL, so the host's clock has seen all of the frame.
    const std::chrono::duration<double, std::milli> span = std::chrono::steady_clock::now() - begun;
    (void)controller->observe(
        {.frame = frame.frame_index + 1, .render_extent = render, .gpu_ms = span.count()});
  }

  if (!window->makeCurrent()) std::quick_exit(0);  // closed, and all of OpenGL's objects with it
  if (frames > 0) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(output.width, output.height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(picture, 0, GL_RGB, GL_UNSIGNED_BYTE,
                      static_cast<GLsizei>(image->getTotalSizeInBytes()), image->data());
    if (!osgDB::writeImageFile(*image, argv[5])) fail(std::string("cannot write '") + argv[5] + "'");
  }
  return 0;
}
