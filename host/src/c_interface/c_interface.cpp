// SPDX-License-Identifier: MIT
// The functions of quincunx.h. Each checks its pointers, calls the library and lets no exception out.
#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "c_interface/c_frame.h"
#include "c_interface/calls.h"
#include "c_interface/sized_struct.h"
#include "quincunx/advanced/device_profile.h"
#include "quincunx/advanced/log.h"
#include "quincunx/quincunx.h"
#include "quincunx/resolve_service.h"

struct quincunx_plan {
  quincunx::ResolvePlan plan;
  std::string text;
};

struct quincunx_service {
  quincunx::c::HostImages host;  // before the service, which waits for its frames when it ends
  quincunx::ResolveService service;
};

using quincunx::Status;
using quincunx::StatusCode;

using quincunx::c::create;
using quincunx::c::guarded;
using quincunx::c::Made;
using quincunx::c::null;

namespace quincunx::c {
namespace {

thread_local std::string message;  // text of quincunx_last_error()

quincunx_status code_of(StatusCode code) {
  switch (code) {
    case StatusCode::kOk:
      return QUINCUNX_OK;
    case StatusCode::kInvalidArgument:
      return QUINCUNX_INVALID_ARGUMENT;
    case StatusCode::kUnsupported:
      return QUINCUNX_UNSUPPORTED;
    case StatusCode::kDeviceFailure:
      return QUINCUNX_DEVICE_FAILURE;
    case StatusCode::kIoFailure:
      return QUINCUNX_IO_FAILURE;
  }
  return QUINCUNX_INTERNAL;
}

quincunx_status report(quincunx_status code, const char* text) noexcept {
  try {
    message = text;
  } catch (...) {
    message.clear();
  }
  return code;
}

}  // namespace

quincunx_status report(const Status& status) {
  if (status.ok()) return QUINCUNX_OK;
  message = status.message();
  // It may repeat a caller's name, line ends too. Other messages may have a compiler's log, whose lines stay.
  if (status.code() == StatusCode::kInvalidArgument) {
    const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == 0x7f; };
    std::replace_if(message.begin(), message.end(), is_control, '?');
  }
  return code_of(status.code());
}

quincunx_status report_exception() noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return report(QUINCUNX_OUT_OF_MEMORY, "out of host memory");
  } catch (const std::exception& error) {
    return report(QUINCUNX_INTERNAL, error.what());
  } catch (...) {
    return report(QUINCUNX_INTERNAL, "an unknown error in the library");
  }
}

}  // namespace quincunx::c

namespace {

Made<quincunx_device> device_of(quincunx::Result<quincunx::Device> opened) {
  if (!opened.ok()) return opened.status();
  std::string profile = opened->profile().describe();
  return std::make_unique<quincunx_device>(quincunx_device{std::move(opened).value(), std::move(profile)});
}

Made<quincunx_plan> plan_of(quincunx::ResolvePlan plan) {
  std::string text = plan.explain();
  return std::make_unique<quincunx_plan>(quincunx_plan{std::move(plan), std::move(text)});
}

}  // namespace

int32_t quincunx_api_version(void) {
  return QUINCUNX_API_VERSION;
}

const char* quincunx_version(void) {
  return QUINCUNX_VERSION;
}

const char* quincunx_last_error(void) {
  return quincunx::c::message.c_str();
}

static_assert(static_cast<int>(quincunx::LogLevel::kError) == QUINCUNX_LOG_ERROR);

quincunx_status quincunx_set_log(quincunx_log_function function, void* user) {
  return guarded([=]() -> Status {
    if (function == nullptr) {
      quincunx::set_log({});
    } else {
      quincunx::set_log([=](quincunx::LogLevel level, const std::string& line) {
        function(static_cast<int32_t>(level), line.c_str(), user);
      });
    }
    return {};
  });
}

quincunx_status quincunx_settings_init(quincunx_settings* settings) {
  return guarded([&]() -> Status {
    if (Status status = quincunx::c::check_size(settings, "settings"); !status.ok()) return status;
    quincunx::c::write_sized(quincunx::c::to_c({}), settings);
    return {};
  });
}

void quincunx_jitter(uint64_t frame_index, int32_t render_width, int32_t render_height, int32_t output_width,
                     int32_t output_height, float jitter[2]) {
  if (jitter == nullptr) return;
  const quincunx::Vec2 at =
      quincunx::jitter(frame_index, {render_width, render_height}, {output_width, output_height});
  jitter[0] = at.x;
  jitter[1] = at.y;
}

int32_t quincunx_jitter_phases(int32_t render_width, int32_t render_height, int32_t output_width,
                               int32_t output_height) {
  return quincunx::jitter_phases({render_width, render_height}, {output_width, output_height});
}

float quincunx_texture_lod_bias(int32_t render_width, int32_t render_height, int32_t output_width,
                                int32_t output_height) {
  return quincunx::texture_lod_bias({render_width, render_height}, {output_width, output_height});
}

const char* quincunx_method_name(int32_t method) {
  const auto methods = quincunx::methods();
  if (method < 0 || method >= static_cast<int32_t>(methods.size())) return nullptr;
  return methods[static_cast<std::size_t>(method)].name;
}

const char* quincunx_variant_name(int32_t variant) {
  const auto variants = quincunx::all_variants();
  if (variant < 0 || variant >= static_cast<int32_t>(variants.size())) return nullptr;
  return variants[static_cast<std::size_t>(variant)].name.c_str();
}

quincunx_status quincunx_settings_set_method(quincunx_settings* settings, const char* name) {
  return guarded({{"name", name}}, [&]() -> Status {
    quincunx_settings own = quincunx::c::to_c({});
    if (Status status = quincunx::c::read_sized(settings, "settings", own); !status.ok()) return status;
    const auto variant = quincunx::parse_variant(name);
    if (!variant.ok()) return variant.status();
    own.struct_size = sizeof own;
    own.method = static_cast<int>(variant->method);  // a bad one is replaced, too
    auto scene = quincunx::c::from_c(&own);
    if (!scene.ok()) return scene.status();
    quincunx::apply(*variant, scene->resolve);
    quincunx::c::write_sized(quincunx::c::to_c(*scene), settings);
    return {};
  });
}

quincunx_status quincunx_plan_create(const quincunx_settings* settings, quincunx_plan** plan) {
  return create("plan", plan, [&]() -> Made<quincunx_plan> {
    const auto scene = quincunx::c::from_c(settings);
    if (!scene.ok()) return scene.status();
    auto made = quincunx::plan_for(scene->needs, scene->resolve);
    if (!made.ok()) return quincunx::c::in_c_words(made.status());
    return plan_of(std::move(made).value());
  });
}

quincunx_status quincunx_plan_focus(const quincunx_plan* plan, quincunx_plan** region) {
  return create("region", region, [&]() -> Made<quincunx_plan> {
    if (plan == nullptr) return null("plan");
    auto focus = plan->plan.focus_plan();
    if (!focus) return Status::invalid("the plan has no focus; set settings.focus_width and focus_height");
    return plan_of(std::move(*focus));
  });
}

int32_t quincunx_plan_reads_history(const quincunx_plan* plan, int32_t render_width, int32_t render_height,
                                    int32_t output_width, int32_t output_height) {
  if (plan == nullptr || render_width < 1 || render_height < 1) return 0;
  return plan->plan.reads_history({render_width, render_height}, {output_width, output_height});
}

void quincunx_plan_destroy(quincunx_plan* plan) {
  delete plan;
}

quincunx_status quincunx_plan_needs(const quincunx_plan* plan, quincunx_needs* needs) {
  return guarded({{"plan", plan}}, [&]() -> Status {
    if (Status status = quincunx::c::check_size(needs, "needs"); !status.ok()) return status;
    quincunx::c::write_sized(quincunx::c::needs_of(plan->plan), needs);
    return {};
  });
}

const char* quincunx_plan_text(const quincunx_plan* plan) {
  return plan != nullptr ? plan->text.c_str() : nullptr;
}

quincunx_status quincunx_device_open(const char* selector, quincunx_device** device) {
  return create("device", device,
                [&] { return device_of(quincunx::Device::open(selector != nullptr ? selector : "")); });
}

quincunx_status quincunx_device_borrow(void* context, void* id, void* queue, quincunx_device** device) {
  return create("device", device, [&] {
    return device_of(quincunx::Device::borrow(static_cast<cl_context>(context), static_cast<cl_device_id>(id),
                                              static_cast<cl_command_queue>(queue)));
  });
}

void quincunx_device_destroy(quincunx_device* device) {
  delete device;
}

const char* quincunx_device_name(const quincunx_device* device) {
  return device != nullptr ? device->device.info().name.c_str() : nullptr;
}

const char* quincunx_device_profile(const quincunx_device* device) {
  return device != nullptr ? device->profile.c_str() : nullptr;
}

const char* quincunx_device_pass_timer(const quincunx_device* device) {
  return device != nullptr ? name_of(quincunx::pass_timer(device->device)) : nullptr;
}

void* quincunx_device_context(const quincunx_device* device) {
  return device != nullptr ? device->device.context() : nullptr;
}

void* quincunx_device_id(const quincunx_device* device) {
  return device != nullptr ? device->device.id() : nullptr;
}

void* quincunx_device_queue(const quincunx_device* device) {
  return device != nullptr ? device->device.queue() : nullptr;
}

quincunx_status quincunx_service_create(const quincunx_device* device, const quincunx_plan* plan,
                                        quincunx_service** service) {
  return create("service", service, [&]() -> Made<quincunx_service> {
    if (device == nullptr) return null("device");
    if (plan == nullptr) return null("plan");
    auto made = quincunx::ResolveService::create(device->device, plan->plan);
    if (!made.ok()) return made.status();
    return std::unique_ptr<quincunx_service>(
        new quincunx_service{{device->device, plan->plan}, std::move(made).value()});
  });
}

void quincunx_service_destroy(quincunx_service* service) {
  delete service;
}

quincunx_status quincunx_validate(const quincunx_plan* plan, const quincunx_inputs* inputs,
                                  const quincunx_outputs* outputs) {
  return guarded({{"plan", plan}},
                 [&] { return quincunx::c::checked_frame(plan->plan, inputs, outputs).status(); });
}

quincunx_status quincunx_dispatch(quincunx_service* service, const quincunx_inputs* inputs,
                                  const quincunx_outputs* outputs, quincunx_report* report) {
  cl_event* done = nullptr;
  const quincunx_status result = guarded({{"service", service}}, [&]() -> Status {
    quincunx_report own = {};
    if (report != nullptr) {
      const auto read = quincunx::c::read_report(report);
      if (!read.ok()) return read.status();
      own = *read;
    }
    auto frame = quincunx::c::checked_frame(service->service.plan(), inputs, outputs);
    if (!frame.ok()) return frame.status();
    done = frame->sync.done;
    if (Status status = service->host.bring(frame.value()); !status.ok()) return status;
    const quincunx::FrameReport made =
        frame->focus ? service->service.dispatch(frame->inputs, *frame->focus, frame->outputs, frame->sync)
                     : service->service.dispatch(frame->inputs, frame->outputs, frame->sync);
    if (!made.ok()) return quincunx::c::in_c_words(made.status);
    if (report != nullptr) quincunx::c::write_report(made, own, report);
    return service->host.fetch(frame.value());
  });
  if (result != QUINCUNX_OK && done != nullptr &&
      *done != nullptr) {  // the frame ran, and its picture is lost
    clReleaseEvent(*done);
    *done = nullptr;
  }
  return result;
}

quincunx_status quincunx_next_report(quincunx_service* service, quincunx_report* report) {
  bool ready = true;
  const quincunx_status status = guarded({{"service", service}}, [&]() -> Status {
    const auto own = quincunx::c::read_report(report);
    if (!own.ok()) return own.status();
    const auto completed = service->service.next_completed();
    ready = completed.has_value();
    if (ready) quincunx::c::write_report(*completed, *own, report);
    return {};
  });
  return ready ? status : QUINCUNX_NOT_READY;
}

quincunx_status quincunx_allow_timing_waits(quincunx_service* service, int32_t allow) {
  return guarded({{"service", service}}, [&]() -> Status {
    service->service.allow_timing_waits(allow != 0);
    return {};
  });
}

quincunx_status quincunx_clear(quincunx_service* service, const quincunx_image* image, int32_t width,
                               int32_t height, const float value[4]) {
  return guarded({{"service", service}, {"value", value}}, [&]() -> Status {
    const auto view = quincunx::c::memory_object("image", image);
    return view.ok() ? quincunx::c::in_c_words(service->service.clear(view.value(), {width, height}, value))
                     : view.status();
  });
}

quincunx_status quincunx_finish(quincunx_service* service) {
  return guarded({{"service", service}}, [&] { return service->service.finish(); });
}
