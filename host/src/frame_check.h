// SPDX-License-Identifier: MIT
// FrameCheck: complaints about the fields of a frame, collected so that one message names every bad one.
#pragma once

#include <string>

#include "quincunx/focus.h"
#include "quincunx/resolve_plan.h"
#include "quincunx/status.h"

namespace quincunx {

class FrameCheck {
 public:
  explicit FrameCheck(const ResolvePlan& plan) : plan_(plan) {}

  void input(const char* field, const ImageView& image, PixelFormat format, Extent viewport);
  void viewport(const char* field, Extent viewport, Extent target);
  // Of just this extent.
  void output(const char* field, const ImageView& image, PixelFormat format, Storage storage, Extent extent,
              const char* whose);
  void finite(const char* field, float value, float low, float high);

  void complain(const std::string& text) { complaints_ += (complaints_.empty() ? "" : "; ") + text; }
  Status status() const { return complaints_.empty() ? Status() : Status::invalid(complaints_); }

 private:
  void image_in(const char* field, const ImageView& image, PixelFormat format, Storage storage);
  void layout(const char* field, const ImageView& image);

  const ResolvePlan& plan_;
  std::string complaints_;
};

void check_inputs(FrameCheck& check, const ResolvePlan& plan, const FrameInputs& inputs);

// What validate() says of a focus. `region` is the plan's focus_plan(), null where it has none.
Status validate_focus(const ResolvePlan& plan, const ResolvePlan* region, const FocusInputs& focus);

}  // namespace quincunx
