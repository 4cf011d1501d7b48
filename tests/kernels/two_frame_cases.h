// SPDX-License-Identifier: MIT
// TwoFrameCases: what every pass that resolves two frames must do. A test's fixture says how its pass runs, and how its
// result is compared.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel_fixture.h"

namespace quincunx::testing {

class TwoFrameCases {
 protected:
  struct Resolved {
    std::vector<unsigned char> bytes;
    std::vector<Pixel> pixels;
    std::int64_t non_finite = 0;
  };

  virtual ~TwoFrameCases() = default;

  virtual Resolved resolve(Rig& rig, const TestFrame& current, const TestFrame& previous, Extent output) = 0;
  // A frame of `formats_` with the units of its velocity, and the camera.
  virtual TestFrame with_motion(TestFrame made) const = 0;
  // With the reference; ends in a fatal failure where they differ.
  virtual void compare(const FrameSpec& now, const FrameSpec& before, Extent output) = 0;

  TestFrame frame(Rig& rig, const FrameSpec& spec) const;
  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::vector<Pixel>& colour) const;

  // Opposite jitters, both frames of other extents; the largest output meets one pattern a scale.
  void compare_at_every_size_scale_and_input(Extent largest);
  // From nothing over less than a rounding to far beyond the screen; and a row of the widest screens.
  void compare_at_any_speed_and_with_the_widest_rows();
  void poison_outside_the_viewport_changes_no_bit();
  // Under a memory checker this also shows that nothing beyond the viewport is read.
  void a_tight_image_gives_the_same_bits();
  void two_runs_agree_bit_for_bit();

  ResolveSettings settings_;
  FrameFormats formats_;
};

// Returns the name of a comparison, for its message.
std::string name_of(const FrameSpec& now, const FrameSpec& before, Extent output);

}  // namespace quincunx::testing
