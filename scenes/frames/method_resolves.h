// SPDX-License-Identifier: MIT
// MethodResolves: frames resolved by the methods that a controller chooses for them.
//
// Each method has a ResolveService of its own, so a change allocates and compiles nothing. A method that has not
// resolved the frame before begins without history. While a choice fades, both methods resolve the frame, and the
// pictures are mixed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "frames/frame_source.h"
#include "quincunx/control/quality_controller.h"
#include "quincunx/resolve_service.h"
#include "tools/program/jitter.h"

namespace quincunx::scenes {

// The settings with a method's own in their place, for a service among others that a controller chooses between.
ResolveSettings method_settings(const ResolveSettings& settings, const MethodVariant& method);

// How a frame is drawn for a choice: while it fades, with the jitter of the method that bears less of it, which would
// flicker by the other's. One that accumulates keeps what it has.
struct MethodSampling {
  tools::Jitter jitter = tools::Jitter::kNone;
  TextureDetail detail = {};
};
MethodSampling sampling_for(const QualityChoice& choice);

// Resolves a frame. `focus` null: it has none; services whose plan has no focus ignore it.
FrameReport dispatch(ResolveService& service, const FrameInputs& inputs, const FocusInputs* focus,
                     const FrameOutputs& outputs);

class MethodResolves {
 public:
  // Connects the source. `methods`: to choose from; empty: the one of the settings. `beside`: further settings that the
  // source is connected for. Errors: of any part, as that part words them.
  static Result<MethodResolves> create(FrameSource& source, const ResolveSettings& settings,
                                       std::vector<MethodVariant> methods,
                                       std::vector<ResolveSettings> beside = {});

  // The first method's; targets, formats and storage are the same in all.
  const ResolvePlan& plan() const { return services_.front().plan(); }
  // The plans of the further settings, in their order.
  const std::vector<ResolvePlan>& plans_beside() const { return plans_beside_; }

  // Resolves a frame. `focus` as above. `choice`: of these methods; nothing where there is one.
  FrameReport dispatch(FrameInputs inputs, const FocusInputs* focus, const FrameOutputs& outputs,
                       const std::optional<QualityChoice>& choice);

  // Does what ResolveService does. The report of a frame with two methods has the passes of both. Its content tells of
  // cuts, too: `inputs.reset` of dispatch().
  std::optional<FrameReport> next_completed();
  void allow_timing_waits(bool allow);
  Status finish();

 private:
  struct Dispatched {
    std::size_t method = 0;
    std::optional<std::size_t> fading_from;
    bool cut = false;
    std::optional<FrameReport> report = {};
    std::optional<FrameReport> fading_report = {};
  };

  MethodResolves(std::vector<MethodVariant> methods, std::vector<ResolveService> services, Image fading);
  std::size_t index_of(const MethodVariant& method) const;
  FrameReport dispatch(std::size_t method, FrameInputs inputs, const FocusInputs* focus,
                       const FrameOutputs& outputs);

  std::vector<MethodVariant> methods_;
  std::vector<ResolveService> services_;
  std::vector<ResolvePlan> plans_beside_;
  std::vector<std::optional<std::uint64_t>> last_frame_;  // that each has resolved
  Image fading_;                                          // picture of the method that is left
  std::vector<Dispatched> dispatched_;                    // and not yet completed, oldest first
};

}  // namespace quincunx::scenes
