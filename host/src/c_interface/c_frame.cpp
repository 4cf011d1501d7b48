// SPDX-License-Identifier: MIT
#include "c_interface/c_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "c_interface/sized_struct.h"
#include "quincunx/c_settings.h"

namespace quincunx::c {
namespace {

struct GivenImage {
  ImageView view;
  HostMemory host;
};

Status bad(const char* name, const std::string& what) {
  return Status::invalid(fmt::format("{}.{}", name, what));
}

// Checks what validate() cannot know of images in host memory.
Status check_host(const char* name, const quincunx_image& image, const ImageView& view) {
  const std::size_t row = static_cast<std::size_t>(std::max(image.width, 0)) * bytes_per_pixel(view.format);
  if (image.offset != 0)
    return bad(name, fmt::format("offset is {}; in host memory it must be 0", image.offset));
  if (image.pitch != 0 && image.pitch < row) {
    return bad(name, fmt::format("pitch is {}; a row of {} texels of {} takes {}", image.pitch, image.width,
                                 name_of(view.format), row));
  }
  return {};
}

// `storage` is what an image in host memory passes for.
Result<GivenImage> read_image(const char* name, const quincunx_image* given, Storage storage) {
  if (given == nullptr) return GivenImage();
  quincunx_image image = {};
  if (Status status = read_sized(given, name, image); !status.ok()) return status;
  if (image.place < QUINCUNX_BUFFER || image.place > QUINCUNX_HOST) {
    return bad(name, fmt::format("place is {}; it must lie in [0, {}]", image.place, int{QUINCUNX_HOST}));
  }
  if (image.format < QUINCUNX_R8 || image.format > QUINCUNX_RGBA32F) {
    return bad(name, fmt::format("format is {}; it must lie in [{}, {}]", image.format, int{QUINCUNX_R8},
                                 int{QUINCUNX_RGBA32F}));
  }
  if (image.memory == nullptr) return bad(name, "memory is NULL; it must be a cl_mem or host memory");
  GivenImage made;
  made.view = {.memory = static_cast<cl_mem>(image.memory),
               .storage = image.place == QUINCUNX_HOST ? storage : static_cast<Storage>(image.place),
               .format = static_cast<PixelFormat>(image.format),
               .extent = {image.width, image.height},
               .offset = image.offset,
               .pitch = image.pitch};
  if (image.place != QUINCUNX_HOST) return made;
  made.view.pitch = 0;
  const std::size_t row =
      static_cast<std::size_t>(std::max(image.width, 0)) * bytes_per_pixel(made.view.format);
  made.host = {image.memory, image.pitch != 0 ? image.pitch : row};
  const Status status = check_host(name, image, made.view);
  return status.ok() ? Result<GivenImage>(made) : status;
}

template <std::size_t Count, typename Images, typename Views>
Status read_images(const std::array<const char*, Count>& names, const Images& images,
                   const std::array<Storage, Count>& storages,
                   const std::array<ImageView Views::*, Count>& members, Views& views,
                   std::array<HostMemory, Count>& host) {
  for (std::size_t i = 0; i < Count; ++i) {
    auto image = read_image(names[i], images[i], storages[i]);
    if (!image.ok()) return image.status();
    views.*members[i] = image->view;
    host[i] = image->host;
  }
  return {};
}

void read_numbers(const quincunx_inputs& from, FrameInputs& to) {
  to.render_extent = {from.render_width, from.render_height};
  to.jitter = {from.jitter_x, from.jitter_y};
  to.velocity_scale = {from.velocity_scale_x, from.velocity_scale_y};
  const auto& matrix = from.clip_to_previous_clip;
  const bool stands_still =
      std::all_of(std::begin(matrix), std::end(matrix), [](float element) { return element == 0; });
  if (!stands_still) std::copy(std::begin(matrix), std::end(matrix), to.camera.clip_to_previous_clip.begin());
  to.near_plane = from.near_plane;
  to.far_plane = from.far_plane;
  to.exposure = from.exposure;
  to.reset = from.reset != 0;
  to.parity = from.parity;
  to.frame_index = from.frame_index;
}

}  // namespace

Result<Frame> checked_frame(const ResolvePlan& plan, const quincunx_inputs* inputs,
                            const quincunx_outputs* outputs) {
  quincunx_inputs in = {};
  quincunx_outputs out = {};
  if (Status status = read_sized(inputs, "inputs", in); !status.ok()) return status;
  if (Status status = read_sized(outputs, "outputs", out); !status.ok()) return status;
  Frame frame;
  const Storage storage = plan.settings.storage;
  Status status = read_images<4>(
      {"colour", "depth", "velocity", "reactive"}, std::array{in.colour, in.depth, in.velocity, in.reactive},
      {storage, storage, storage, storage}, kInputImages, frame.inputs, frame.host_inputs);
  if (!status.ok()) return status;
  status = read_images<2>({"linear", "presented"}, std::array{out.linear, out.presented},
                          {Storage::kBuffer, plan.presented_storage()}, kOutputImages, frame.outputs,
                          frame.host_outputs);
  if (!status.ok()) return status;
  read_numbers(in, frame.inputs);
  status = validate(plan, frame.inputs, frame.outputs);
  return status.ok() ? Result<Frame>(frame) : status;
}

Result<ImageView> memory_object(const char* name, const quincunx_image* image) {
  if (image == nullptr) return Status::invalid(fmt::format("{} is NULL; it must point to one", name));
  auto read = read_image(name, image, Storage::kBuffer);
  if (!read.ok()) return read.status();
  if (read->host.texels != nullptr) return bad(name, "place is host memory; it must be a memory object");
  return read->view;
}

Status check_report(const quincunx_report* report) {
  if (Status status = check_size(report, "report"); !status.ok()) return status;
  if (report->passes != nullptr && report->pass_capacity < 0) {
    return Status::invalid(
        fmt::format("report.pass_capacity is {}; it must be at least 0", report->pass_capacity));
  }
  return {};
}

void write_report(const FrameReport& from, quincunx_report* to) {
  quincunx_report report = {};
  report.passes = to->passes;
  report.pass_capacity = to->pass_capacity;
  report.pass_count = static_cast<int>(from.passes.size());
  report.frame_index = from.frame_index;
  report.non_finite_pixels = from.non_finite_pixels;
  report.render_width = from.render_extent.width;
  report.render_height = from.render_extent.height;
  report.ratio_x = from.ratio.x;
  report.ratio_y = from.ratio.y;
  report.used_previous = from.used_previous;
  const int count = to->passes != nullptr ? std::min(report.pass_count, to->pass_capacity) : 0;
  for (int i = 0; i < count; ++i) {
    const PassReport& pass = from.passes[static_cast<std::size_t>(i)];
    to->passes[i] = {pass.kernel, pass.ms, pass.bytes};
  }
  write_sized(report, to);
}

HostImages::HostImages(const Device& device, const ResolvePlan& plan)
    : device_(device),
      target_(plan.settings.target_extent),
      output_(plan.settings.output_extent),
      placed_(plan.settings.targets == Targets::kPlaced) {}

Status HostImages::make(Image& image, Extent extent, const ImageView& like) const {
  if (image) return {};
  auto made = device_.allocate(extent, like.format, like.storage);
  if (made.ok()) image = std::move(made).value();
  return made.status();
}

Status HostImages::input(Image& image, const HostMemory& host, Extent render, ImageView& view) const {
  if (Status status = make(image, target_, view); !status.ok()) return status;
  view = image.view();
  if (placed_) {
    view.extent = render;
    view.pitch = 0;
  }
  return device_.upload(view, render, host.texels, host.row_bytes);
}

Status HostImages::bring(Frame& frame) {
  for (std::size_t i = 0; i < kInputImages.size(); ++i) {
    if (frame.host_inputs[i].texels == nullptr) continue;
    const Status status = input(inputs_[turn_][i], frame.host_inputs[i], frame.inputs.render_extent,
                                frame.inputs.*kInputImages[i]);
    if (!status.ok()) return status;
  }
  for (std::size_t i = 0; i < kOutputImages.size(); ++i) {
    if (frame.host_outputs[i].texels == nullptr) continue;
    ImageView& view = frame.outputs.*kOutputImages[i];
    if (Status status = make(outputs_[i], output_, view); !status.ok()) return status;
    view = outputs_[i].view();
  }
  return {};
}

Status HostImages::fetch(const Frame& frame) {
  turn_ = 1 - turn_;
  for (std::size_t i = 0; i < kOutputImages.size(); ++i) {
    const HostMemory& host = frame.host_outputs[i];
    if (host.texels == nullptr) continue;
    const Status status =
        device_.download(frame.outputs.*kOutputImages[i], output_, host.texels, host.row_bytes);
    if (!status.ok()) return status;
  }
  return {};
}

}  // namespace quincunx::c
