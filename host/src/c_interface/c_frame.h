// SPDX-License-Identifier: MIT
// Settings and frames of the C interface as the library's own, with images in host memory, and settings and reports
// back. Pure, but for HostImages.
#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <optional>

#include "plan/resources.h"
#include "quincunx/c/frame.h"
#include "quincunx/c/settings.h"
#include "quincunx/device.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/resolve_service.h"

namespace quincunx::c {

struct SceneSettings {
  SceneNeeds needs;
  ResolveSettings resolve;
};

// struct_size is 0.
quincunx_settings to_c(const SceneSettings& settings);

// Errors: kInvalidArgument for a struct_size that is none, and for a number that is no value of its field; the
// message names the field. Checks that plan_for() makes are left to it.
Result<SceneSettings> from_c(const quincunx_settings* settings);

// struct_size is 0.
quincunx_needs needs_of(const ResolvePlan& plan);

// Returns the status with C's names of the fields in place of those of C++.
Status in_c_words(const Status& status);

// An image in host memory that stands for `view`, whose memory is then only a name for it.
struct HostMemory {
  void* texels = nullptr;     // null: the image is a memory object
  std::size_t row_bytes = 0;  // from one row to the next; 0: tightly packed
};

constexpr std::array kOutputImages = {&FrameOutputs::linear, &FrameOutputs::presented};

using HostInputs = std::array<HostMemory, std::size(kInputs)>;  // of each row

struct Frame {
  FrameInputs inputs;
  std::optional<FocusInputs> focus;
  FrameOutputs outputs;
  FrameSync sync;
  HostInputs host_inputs;
  HostInputs host_focus;
  HostMemory host_mask;
  std::array<HostMemory, kOutputImages.size()> host_outputs;
};

// Returns a frame that has passed validate(); it refers to the events of `inputs`. Sets the event that is asked for to
// NULL, whatever else is wrong. Errors: kInvalidArgument; the message names the field.
Result<Frame> checked_frame(const ResolvePlan& plan, const quincunx_inputs* inputs,
                            const quincunx_outputs* outputs);

// Reads a view of a memory object. Errors: kInvalidArgument.
Result<ImageView> memory_object(const char* name, const quincunx_image* image);

// Returns the fields that the caller has. Errors: kInvalidArgument.
Result<quincunx_report> read_report(const quincunx_report* report);
// Writes to `to`, of which read_report() has made `report`.
void write_report(const FrameReport& from, quincunx_report report, quincunx_report* to);

quincunx_content content_to_c(const ContentStatistics& content);  // struct_size is 0
// Errors: kInvalidArgument; the message names the field.
Result<ContentStatistics> content_of(const quincunx_content* given);

// Images on the device that stand for the inputs of a plan's frames where those are host memory. They are made when
// host memory is first given in their place, and kept: two for each input that the next frame reads. As thread safe as
// its Device.
class HostStream {
 public:
  HostStream(const Device& device, const ResolvePlan& plan) : device_(device), plan_(plan) {}

  // Copies inputs of host memory to the device and makes the frame's views name the copies. Errors: of the device.
  Status bring(FrameInputs& inputs, const HostInputs& host);

  void advance() { turn_ = 1 - turn_; }  // the frame was taken

 private:
  using Images = std::array<Image, std::size(kInputs)>;

  Device device_;
  ResolvePlan plan_;
  std::array<Images, 2> images_;  // this frame's and those of the one before, in turns
  std::size_t turn_ = 0;
};

// Lets a service read and write host memory.
class HostImages {
 public:
  HostImages(const Device& device, const ResolvePlan& plan);

  // As HostStream::bring(), and as well for outputs, whose copies are fetched later.
  Status bring(Frame& frame);

  // After a frame was dispatched: waits for it where its outputs are host memory, and copies them there. Errors: of the
  // device.
  Status fetch(const Frame& frame);

 private:
  Device device_;
  Extent output_;
  HostStream picture_;
  std::optional<HostStream> focus_;
  Extent region_;  // the focus's
  Image mask_;
  std::array<Image, kOutputImages.size()> outputs_;
};

}  // namespace quincunx::c
