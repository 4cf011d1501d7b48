// SPDX-License-Identifier: MIT
#include "window/screen.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "quincunx_gl/capabilities.h"
#include "quincunx_gl/gl_calls.h"
#include "render/gl_program.h"
#include "tools/image/false_colour.h"

namespace quincunx::scenes {
namespace {

constexpr const char* kWholeViewport = "sky.vert.glsl";

enum Uniform : GLint { kWindow = 0, kOrigin = 1, kZoom = 2, kSplit = 3 };  // locations in picture.frag

int corner(float centre, int factor, int extent) {
  const int shown = std::max(extent / factor, 1);
  const int middle = static_cast<int>(std::lround(centre * static_cast<float>(extent)));
  return std::clamp(middle - shown / 2, 0, extent - shown);
}

constexpr float kFontPixels = 14;

// Dear ImGui as distributions build it asks for state that desktop OpenGL alone has. OpenGL ES refuses that and changes
// nothing, so for the life of the guard the refusals are neither logged nor left behind.
class RefusalsOfEs {
 public:
  RefusalsOfEs() {
    if (is_es_) glDisable(GL_DEBUG_OUTPUT);
  }
  ~RefusalsOfEs() {
    if (!is_es_) return;
    while (glGetError() != GL_NO_ERROR) {
    }
    glEnable(GL_DEBUG_OUTPUT);
  }
  RefusalsOfEs(const RefusalsOfEs&) = delete;
  RefusalsOfEs& operator=(const RefusalsOfEs&) = delete;

 private:
  bool is_es_ = gl::capabilities().api == gl::Api::kEs3;
};

void load_font() {
  // Characters of the interface beyond Latin: multiplication sign, arrows, dots, ellipsis.
  static const ImWchar kGlyphs[] = {0x0020, 0x00ff, 0x2010, 0x2027, 0x2190, 0x2193, 0x2260, 0x2265, 0};
  const char* path = tools::font_path(tools::Face::kSans);
  if (std::filesystem::exists(path)) {
    ImGui::GetIO().Fonts->AddFontFromFileTTF(path, kFontPixels, nullptr, kGlyphs);
  } else {
    ImGui::GetIO().Fonts->AddFontDefault();
  }
}

void set_looks() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 8;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.PopupRounding = 6;
  style.ScrollbarRounding = 6;
  style.ScrollbarSize = 10;
  style.WindowBorderSize = 0;
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 2};
  style.ItemSpacing = {8, 4};
  const ImVec4 accent(.91f, .64f, .24f, 1);
  const ImVec4 dim(.91f, .64f, .24f, .35f);
  const ImVec4 half(.91f, .64f, .24f, .6f);
  ImVec4* colours = style.Colors;
  colours[ImGuiCol_WindowBg] = {.07f, .075f, .09f, .86f};
  colours[ImGuiCol_PopupBg] = {.09f, .095f, .11f, .97f};
  colours[ImGuiCol_Text] = {.92f, .92f, .93f, 1};
  colours[ImGuiCol_TextDisabled] = {.60f, .61f, .64f, 1};
  colours[ImGuiCol_FrameBg] = {1, 1, 1, .09f};
  colours[ImGuiCol_FrameBgHovered] = {1, 1, 1, .15f};
  colours[ImGuiCol_FrameBgActive] = {1, 1, 1, .20f};
  colours[ImGuiCol_Button] = {1, 1, 1, .12f};
  colours[ImGuiCol_ButtonHovered] = dim;
  colours[ImGuiCol_ButtonActive] = half;
  colours[ImGuiCol_Header] = dim;
  colours[ImGuiCol_HeaderHovered] = half;
  colours[ImGuiCol_HeaderActive] = half;
  colours[ImGuiCol_CheckMark] = accent;
  colours[ImGuiCol_SliderGrab] = accent;
  colours[ImGuiCol_SliderGrabActive] = accent;
  colours[ImGuiCol_Separator] = {1, 1, 1, .12f};
}

}  // namespace

ZoomOrigin zoom_origin(const ZoomSettings& zoom, Extent picture) {
  return {corner(zoom.centre.x, zoom.factor, picture.width),
          corner(zoom.centre.y, zoom.factor, picture.height)};
}

Result<Screen> Screen::create() {
  auto picture = link_program(kWholeViewport, "picture.frag.glsl", {});
  if (!picture.ok()) return picture.status();
  auto layer = link_program(kWholeViewport, "layer.frag.glsl", {});
  if (!layer.ok()) return layer.status();
  return Screen(std::move(picture).value(), std::move(layer).value());
}

void Screen::show(const ScreenPicture& picture, const ZoomSettings& zoom, float split, Extent window) {
  const ZoomOrigin origin = zoom_origin(zoom, picture.extent);
  const bool splits = picture.compared != 0;
  const auto side = static_cast<int>(std::lround(split * static_cast<float>(window.width)));
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glViewport(0, 0, window.width, window.height);
  glBindVertexArray(nothing_.get());
  glUseProgram(picture_program_.get());
  glUniform2i(kWindow, window.width, window.height);
  glUniform2i(kOrigin, origin.x, origin.y);
  glUniform1i(kZoom, zoom.factor);
  glUniform1i(kSplit, splits ? side : window.width);
  gl::bind_texture(0, picture.picture);
  gl::bind_texture(1, splits ? picture.compared : picture.picture);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::bind_texture(0, 0);
  gl::bind_texture(1, 0);
  glUseProgram(0);
  glBindVertexArray(0);
}

Screen::Layer Screen::layer(Extent window) {
  const bool renewed = layer_extent_ != window;
  if (renewed) {
    layer_texture_ = gl::Texture::create();
    gl::texture_storage(layer_texture_.get(), 1, GL_RGBA8, window);
    layer_framebuffer_ = gl::Framebuffer::create();
    gl::attach(layer_framebuffer_.get(), GL_COLOR_ATTACHMENT0, layer_texture_.get());
    layer_extent_ = window;
    clear_layer();
  }
  return {layer_framebuffer_.get(), renewed};
}

void Screen::clear_layer() {
  const float zero[] = {0, 0, 0, 0};
  gl::clear(layer_framebuffer_.get(), GL_COLOR, 0, zero);
}

void Screen::lay_over(Extent window) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glViewport(0, 0, window.width, window.height);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(nothing_.get());
  glUseProgram(layer_program_.get());
  gl::bind_texture(0, layer_texture_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  gl::bind_texture(0, 0);
  glUseProgram(0);
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

std::vector<std::uint8_t> Screen::read(Extent window) {
  const std::size_t row = static_cast<std::size_t>(window.width) * 4;
  std::vector<std::uint8_t> pixels(row * static_cast<std::size_t>(window.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  glReadPixels(0, 0, window.width, window.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  for (int y = 0; y < window.height / 2; ++y) {
    const auto top = pixels.begin() + static_cast<std::ptrdiff_t>(row) * y;
    const auto bottom = pixels.begin() + static_cast<std::ptrdiff_t>(row) * (window.height - 1 - y);
    std::swap_ranges(top, top + static_cast<std::ptrdiff_t>(row), bottom);
  }
  return pixels;
}

Ui::Ui(GLFWwindow* window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // no file is left behind
  load_font();
  set_looks();
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  const RefusalsOfEs guard;
  ImGui_ImplOpenGL3_Init(gl::capabilities().api == gl::Api::kGl45 ? "#version 450 core" : "#version 300 es");
}

Ui::~Ui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Ui::draw_content(const std::function<void()>& content, GLuint framebuffer, Extent window) {
  const RefusalsOfEs guard;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  content();
  ImGui::Render();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, window.width, window.height);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  ++drawn_;
}

bool Ui::wants_keys() const {
  return ImGui::GetIO().WantTextInput;
}

bool Ui::wants_pointer() const {
  return ImGui::GetIO().WantCaptureMouse;
}

void Ui::draw(const std::function<void()>& content, UiDrawing drawing, Screen& screen, Extent window) {
  if (drawing == UiDrawing::kOver) {
    draw_content(content, 0, window);
    layer_is_fresh_ = false;
    return;
  }
  const Screen::Layer layer = screen.layer(window);
  const bool again = drawing == UiDrawing::kEverySecond && layer_is_fresh_ && !layer.renewed;
  if (!again) {
    screen.clear_layer();
    draw_content(content, layer.framebuffer, window);
  }
  layer_is_fresh_ = !again;
  screen.lay_over(window);
}

}  // namespace quincunx::scenes
