// SPDX-License-Identifier: MIT
// Random calls of quincunx.h, the same ones each time. At the end nothing is left of what was made.
#include <CL/cl.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "../service/c_fixture.h"
#include "c_caller.h"

namespace quincunx::testing {
namespace {

class FrameCaller : public Caller {
 public:
  explicit FrameCaller(std::uint64_t seed);
  ~FrameCaller();

  void run();

 private:
  // How often a device's objects and files are held.
  std::vector<std::uint32_t> held() const;
  quincunx_settings settings();
  quincunx_image* picture(Everything& frame);
  void spoil_image(quincunx_image& image);
  void spoil_frame(Everything& frame);
  void fill_report(Sized<quincunx_report>& report);

  void make_plan();
  void use_plan();
  void set_method();
  void ask_numbers();
  void use_device();
  void import();
  void make_service();
  void dispatch();
  void validate();
  void next_report();
  void clear();
  void finish();
  void destroy();

  quincunx_device* device_ = nullptr;
  std::vector<quincunx_plan*> known_plans_;  // whose kernels are compiled
  std::vector<cl_mem> memory_;
  std::vector<std::uint32_t> held_before_;
  alignas(4096) std::array<unsigned char, 8192> mapped_ = {};
  std::vector<quincunx_pass_report> passes_;
  Sized<quincunx_content> content_;
  std::vector<int> in_focus_;

  Pool<quincunx_plan, quincunx_plan_destroy> plans_{random_};
  Pool<quincunx_device, quincunx_device_destroy> devices_{random_, 2};
  Pool<quincunx_memory, quincunx_memory_destroy> imported_{random_};
  Pool<quincunx_semaphore, quincunx_semaphore_destroy> semaphores_{random_};
  Pool<quincunx_service, quincunx_service_destroy> services_{random_, 3};
};

std::vector<std::uint32_t> FrameCaller::held() const {
  std::vector<std::uint32_t> counts(2);
  clFinish(static_cast<cl_command_queue>(quincunx_device_queue(device_)));
  clGetContextInfo(static_cast<cl_context>(quincunx_device_context(device_)), CL_CONTEXT_REFERENCE_COUNT,
                   sizeof(cl_uint), &counts[0], nullptr);
  clGetCommandQueueInfo(static_cast<cl_command_queue>(quincunx_device_queue(device_)),
                        CL_QUEUE_REFERENCE_COUNT, sizeof(cl_uint), &counts[1], nullptr);
  for (cl_mem memory : memory_)
    clGetMemObjectInfo(memory, CL_MEM_REFERENCE_COUNT, sizeof(cl_uint), &counts.emplace_back(), nullptr);
  counts.push_back(static_cast<std::uint32_t>(std::distance(
      std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator())));
  return counts;
}

quincunx_settings FrameCaller::settings() {
  quincunx_settings settings = one_in(2) ? good_settings() : Everything::settings();
  settings.method = random_.below(11);
  spoil(settings, offsetof(quincunx_settings, moving_objects));
  return settings;
}

void FrameCaller::make_plan() {
  Sized<quincunx_settings> from(settings());
  makes(plans_, [&](auto** to) { return quincunx_plan_create(sized(from), to); });
}

void FrameCaller::use_plan() {
  const quincunx_plan* plan = plans_.any();
  Sized<quincunx_needs> needs;
  writes_sized(needs, [&](auto* given) { return quincunx_plan_needs(plan, given); });
  EXPECT_EQ(quincunx_plan_text(plan) != nullptr, plan != nullptr);
  const int reads =
      quincunx_plan_reads_history(plan, wild_int(random_, 24), wild_int(random_, 18), wild_int(random_, 24),
                                  random_.below(2) * wild_int(random_, 18));
  EXPECT_TRUE(reads == 0 || reads == 1);
  makes(plans_, [&](auto** to) { return quincunx_plan_focus(plan, to); });
}

void FrameCaller::set_method() {
  Sized<quincunx_settings> to(settings());
  writes_sized(to, [&](auto* given) { return quincunx_settings_init(given); });
  const std::string name = method();
  writes(to.value, [&](auto* given) { return quincunx_settings_set_method(given, or_null(name.c_str())); });
}

void FrameCaller::ask_numbers() {
  std::array<int, 4> side;
  for (int& of : side)
    of = wild_int(random_, 4000);
  std::array<float, 2> jitter = {};
  quincunx_jitter(random_.next() >> random_.below(64), side[0], side[1], side[2], side[3],
                  or_null(jitter.data()));
  for (const float of : jitter)
    EXPECT_TRUE(of >= -1 && of <= 1) << of;
  EXPECT_GE(quincunx_jitter_phases(side[0], side[1], side[2], side[3]), 1);
  EXPECT_TRUE(std::isfinite(quincunx_texture_lod_bias(side[0], side[1], side[2], side[3])));
  const int number = wild_int(random_, 20);
  EXPECT_EQ(quincunx_method_name(number) != nullptr, number >= 0 && number <= QUINCUNX_TEMPORAL);
}

void FrameCaller::use_device() {
  if (one_in(30)) {  // slow
    const std::string selector = word(one_in(2) ? "cpu" : "0");
    makes(devices_, [&](auto** to) { return quincunx_device_open(or_null(selector.c_str()), to); });
  }
  makes(devices_, [&](auto** to) {
    return quincunx_device_borrow(or_null(quincunx_device_context(device_)),
                                  or_null(quincunx_device_id(device_)),
                                  or_null(quincunx_device_queue(device_)), to);
  });
  quincunx_device* device = devices_.any();
  EXPECT_EQ(quincunx_device_name(device) != nullptr, device != nullptr);
  EXPECT_EQ(quincunx_device_profile(device) != nullptr, device != nullptr);
  EXPECT_EQ(quincunx_device_pass_timer(device) != nullptr, device != nullptr);
  std::array<std::uint8_t, 16> uuid;
  quincunx_device_uuid(device, or_null(uuid.data()));
}

void FrameCaller::import() {
  Sized<quincunx_external_memory> from;
  from.value.handle = one_in(4) ? wild_int(random_, 3) : QUINCUNX_MAPPED;
  from.value.fd = wild_int(random_, 3, -3);
  from.value.mapped = one_in(8) ? nullptr : mapped_.data() + (one_in(8) ? 4 : 0);
  from.value.bytes = one_in(4) ? 0 : mapped_.size() / 2;
  from.value.device[0] = static_cast<std::uint8_t>(random_.below(2));
  makes(imported_,
        [&](auto** to) { return quincunx_memory_import(one_in(20) ? nullptr : device_, sized(from), to); });
  quincunx_memory* memory = imported_.any();
  EXPECT_EQ(quincunx_memory_object(memory) != nullptr, memory != nullptr);
  worked(quincunx_memory_acquire(memory));
  void* done = this;
  void** to = one_in(2) ? nullptr : &done;
  worked(quincunx_memory_release(memory, to));
  if (to != nullptr && done != nullptr) clReleaseEvent(static_cast<cl_event>(done));
  makes(semaphores_, [&](auto** made) { return quincunx_semaphore_import(device_, from.value.fd, made); });
  worked(quincunx_semaphore_wait(semaphores_.any()));
  worked(quincunx_semaphore_signal(semaphores_.any()));
}

void FrameCaller::make_service() {
  quincunx_plan* plan = known_plans_[random_.next() % known_plans_.size()];
  makes(services_, [&](auto** to) {
    return quincunx_service_create(one_in(20) ? nullptr : device_, one_in(20) ? nullptr : plan, to);
  });
}

quincunx_image* FrameCaller::picture(Everything& frame) {
  HostPicture* const all[] = {&frame.colour, &frame.depth, &frame.velocity, &frame.reactive, &frame.exposure,
                              &frame.other,  &frame.mask,  &frame.linear,   &frame.presented};
  return all[random_.next() % std::size(all)]->image();
}

// What it says of host memory stays within what there is.
void FrameCaller::spoil_image(quincunx_image& image) {
  switch (random_.below(8)) {
    case 0:
      image.struct_size = random_.next() % sizeof(image);
      break;
    case 1:
      image.place = one_in(2) ? -1 : QUINCUNX_HOST + 1 + random_.below(9);
      break;
    case 2:
      image.format = wild_int(random_, 8);
      break;
    case 3:
      image.width = wild_int(random_, 24);
      break;
    case 4:
      image.height = wild_int(random_, 18);
      break;
    case 5:
      image.offset = static_cast<std::size_t>(wild_int(random_, 20)) *
                     static_cast<std::size_t>(1 + 15 * random_.below(2));
      break;
    case 6:
      image.memory = nullptr;
      break;
    default:
      image.pitch = static_cast<std::size_t>(image.place != QUINCUNX_HOST ? wild_int(random_, 500)
                                             : one_in(2)                  ? 1 + random_.below(16)
                                                                          : -1 - random_.below(1000));
  }
}

void FrameCaller::spoil_frame(Everything& frame) {
  const auto scatter = [&](quincunx_inputs& of) {
    spoil(of, offsetof(quincunx_inputs, render_width), offsetof(quincunx_inputs, exposure_image));
  };
  switch (random_.below(24)) {
    case 0:
    case 1:
      return scatter(frame.frame);
    case 2:
      return scatter(frame.region);
    case 3:
      return spoil(frame.particles, offsetof(quincunx_particles, render_width));
    case 4:
      return spoil(frame.focus, offsetof(quincunx_focus, x), offsetof(quincunx_focus, rectangles));
    case 5:
      return spoil(frame.rectangles, 0);
    case 6:
      frame.focus.rectangle_count = one_in(2) ? random_.below(5) : wild_int(random_, 1) % 1000 - 500;
      break;
    case 7:
      frame.focus.feather = wild_float(4);
      break;
    case 8:
      frame.fade.weight = wild_float(0.5);
      break;
    case 9:
      (one_in(2) ? frame.sync.wait_count : frame.sync.signal_semaphore_count) = wild_int(random_, 2);
      break;
    case 10:
      frame.focus.struct_size = random_.next() % sizeof(frame.focus);
      break;
    case 11:
      (one_in(2) ? frame.frame.colour : frame.frame.depth) = nullptr;
      break;
    case 12:
      (one_in(2) ? frame.frame.reactive : frame.frame.velocity) = nullptr;
      break;
    case 13:
      frame.focus.frame = nullptr;
      break;
    case 19:
      frame.focus.mask = nullptr;
      break;
    case 14:
      frame.fade.from = one_in(2) ? nullptr : frame.outputs.linear;
      break;
    case 15:
      (one_in(2) ? frame.outputs.linear : frame.outputs.presented) = nullptr;
      break;
    case 16:
      frame.frame.exposure_image = picture(frame);
      break;
    case 17:
      frame.outputs.linear = picture(frame);
      break;
    case 18:
      frame.region.focus = &frame.focus;
      break;
    default:
      spoil_image(*picture(frame));
  }
}

void FrameCaller::fill_report(Sized<quincunx_report>& report) {
  passes_.resize(static_cast<std::size_t>(random_.below(QUINCUNX_MAX_PASSES)));
  in_focus_.resize(passes_.size());
  report.value.passes = one_in(4) ? nullptr : passes_.data();
  report.value.in_focus = one_in(2) ? nullptr : in_focus_.data();
  report.value.pass_capacity = one_in(20) ? -1 : static_cast<int>(passes_.size());
  content_ = Sized<quincunx_content>();
  report.value.content = one_in(2) ? nullptr : sized(content_);
}

void FrameCaller::dispatch() {
  Everything frame;
  quincunx_inputs& inputs = frame.frame;
  inputs.render_width = 1 + random_.below(kPicture.width);
  inputs.render_height = 1 + random_.below(kPicture.height);
  inputs.reset = one_in(8);
  inputs.jitter_x = random_.signed_unit();
  inputs.frame_index = random_.next();
  if (one_in(2)) inputs.focus = nullptr, inputs.fade = nullptr;
  if (one_in(3)) inputs.exposure_image = nullptr;
  if (one_in(4)) std::memset(frame.colour.image()->memory, random_.below(256), 500);
  for (int i = random_.below(3); i > 0; --i) {
    quincunx_image& moved = *picture(frame);
    moved.place = one_in(6) ? QUINCUNX_IMAGE2D : QUINCUNX_BUFFER;
    moved.memory = memory_[random_.next() % memory_.size()];
    moved.pitch = 0;
  }
  for (int i = random_.below(3); i > 0; --i)
    spoil_frame(frame);
  void* done = this;
  if (one_in(2)) frame.sync.done = &done;
  Sized<quincunx_report> report;
  fill_report(report);
  Sized<quincunx_inputs> in(inputs);
  Sized<quincunx_outputs> out(frame.outputs);
  const auto linear = frame.linear.texels(), presented = frame.presented.texels();
  const bool works = writes_sized(report, [&](auto* given) {
    return quincunx_dispatch(services_.any(), sized(in), sized(out), one_in(2) ? nullptr : given);
  });
  EXPECT_TRUE(works || frame.linear.texels() == linear) << quincunx_last_error();
  EXPECT_TRUE(works || frame.presented.texels() == presented) << quincunx_last_error();
  for (HostPicture* picture : {&frame.linear, &frame.presented})
    EXPECT_TRUE(picture->gaps_are_whole());
  if (works && frame.sync.done != nullptr) {
    ASSERT_NE(done, nullptr);
    if (done != this) clReleaseEvent(static_cast<cl_event>(done));
  } else {
    EXPECT_TRUE(done == nullptr || done == this);
  }
}

void FrameCaller::validate() {
  Everything frame;
  for (int i = random_.below(3); i > 0; --i)
    spoil_frame(frame);
  Sized<quincunx_inputs> in(frame.frame);
  Sized<quincunx_outputs> out(frame.outputs);
  const quincunx_plan* plan = one_in(2) ? plans_.any() : known_plans_[random_.next() % known_plans_.size()];
  worked(quincunx_validate(plan, sized(in), sized(out)));
}

void FrameCaller::next_report() {
  Sized<quincunx_report> report;
  fill_report(report);
  writes_sized(report, [&](auto* given) { return quincunx_next_report(services_.any(), given); });
}

void FrameCaller::clear() {
  Everything frame;
  quincunx_image& image = *picture(frame);
  image.place = one_in(4) ? QUINCUNX_IMAGE2D : QUINCUNX_BUFFER;
  image.memory = memory_[random_.next() % memory_.size()];
  image.pitch = 0;
  if (one_in(3)) spoil_image(image);
  const float value[] = {wild_float(1), wild_float(1), wild_float(1), wild_float(1)};
  worked(quincunx_clear(services_.any(), or_null(&image), wild_int(random_, 24), wild_int(random_, 18),
                        or_null(value)));
}

void FrameCaller::finish() {
  worked(quincunx_finish(services_.any()));
  worked(quincunx_allow_timing_waits(services_.any(), wild_int(random_, 1)));
}

void FrameCaller::destroy() {
  switch (random_.below(4)) {
    case 0:
      return plans_.drop();
    case 1:
      return devices_.drop();
    case 2:
      return imported_.drop();
    default:
      return services_.drop();
  }
}

FrameCaller::FrameCaller(std::uint64_t seed) : Caller(seed) {
  EXPECT_EQ(quincunx_device_open("", &device_), QUINCUNX_OK) << quincunx_last_error();
  quincunx_settings all = Everything::settings();
  all.background = 0;
  all.clear = 1;
  quincunx_settings two_frames = good_settings();
  two_frames.method = QUINCUNX_TWO_FRAMES;
  quincunx_settings one_frame = good_settings();
  one_frame.method = QUINCUNX_BILINEAR;
  for (const quincunx_settings& settings : {all, two_frames, one_frame}) {
    known_plans_.push_back(nullptr);
    EXPECT_EQ(quincunx_plan_create(&settings, &known_plans_.back()), QUINCUNX_OK) << quincunx_last_error();
  }
  auto* const context = static_cast<cl_context>(quincunx_device_context(device_));
  for (const std::size_t bytes : {std::size_t{64}, std::size_t{6912}, std::size_t{6912}, std::size_t{20000}})
    memory_.push_back(clCreateBuffer(context, CL_MEM_READ_WRITE, bytes, nullptr, nullptr));
  const cl_image_format format = {CL_RGBA, CL_UNORM_INT8};
  cl_image_desc picture = {};
  picture.image_type = CL_MEM_OBJECT_IMAGE2D;
  picture.image_width = static_cast<std::size_t>(kPicture.width);
  picture.image_height = static_cast<std::size_t>(kPicture.height);
  memory_.push_back(clCreateImage(context, CL_MEM_READ_WRITE, &format, &picture, nullptr, nullptr));
  for (const int kept : {0, 1}) {  // the first ones leave the device their programs
    for (const quincunx_plan* plan : known_plans_) {
      quincunx_service* service = nullptr;
      EXPECT_EQ(quincunx_service_create(device_, plan, &service), QUINCUNX_OK) << quincunx_last_error();
      services_.add(service);
    }
    if (kept == 0) services_.clear(), held_before_ = held();
  }
}

FrameCaller::~FrameCaller() {
  for (quincunx_plan* plan : known_plans_)
    quincunx_plan_destroy(plan);
  for (cl_mem memory : memory_)
    clReleaseMemObject(memory);
  quincunx_device_destroy(device_);
}

void FrameCaller::run() {
  Caller::run({{"plan", 12, [this] { make_plan(); }},
               {"use_plan", 8, [this] { use_plan(); }},
               {"set_method", 4, [this] { set_method(); }},
               {"numbers", 4, [this] { ask_numbers(); }},
               {"device", 1, [this] { use_device(); }},
               {"import", 2, [this] { import(); }},
               {"service", 1, [this] { make_service(); }},
               {"dispatch", 12, [this] { dispatch(); }},
               {"validate", 16, [this] { validate(); }},
               {"report", 8, [this] { next_report(); }},
               {"clear", 3, [this] { clear(); }},
               {"finish", 2, [this] { finish(); }},
               {"destroy", 2, [this] { destroy(); }}});
  services_.clear();
  plans_.clear();
  devices_.clear();
  imported_.clear();
  semaphores_.clear();
  constexpr std::uint32_t kLast = 16;  // commands that PoCL holds after they are done
  const std::vector<std::uint32_t> now = held();
  for (std::size_t i = 0; i < now.size(); ++i)
    EXPECT_LE(now[i], held_before_[i] + (i < 2 ? kLast : 0)) << i;
}

TEST(CFuzz, Frames) {
  FrameCaller(31).run();
}

}  // namespace
}  // namespace quincunx::testing
