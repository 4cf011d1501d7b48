// SPDX-License-Identifier: MIT
#include "event_judge.h"

#include <fmt/format.h>

namespace quincunx {
namespace {

// The host's span holds the event's; the rest is for clocks of another rate and for stamps that are rounded.
constexpr double kMostOfHost = 1.1;
// Of the growth that the host saw. It saw submission and waking up, too, which may by chance take longer for the
// heavy run.
constexpr double kLeastGrowth = 0.5;

// Stamps are in order when this is asked.
double duration_ms(const EventStamps& stamps) {
  return static_cast<double>(stamps.ended - stamps.started) * 1e-6;
}

std::string doubt_about(const TimedLoad& load) {
  const EventStamps& stamps = load.stamps;
  if (stamps.ended < stamps.started) return "they end before they start";
  if (stamps.started < stamps.submitted) return "they start before they are submitted";
  const double ms = duration_ms(stamps);
  if (ms == 0) return "they last 0 ms";
  if (ms > kMostOfHost * load.host_ms)
    return fmt::format("one lasts {:.3f} ms of the {:.3f} ms that the host saw", ms, load.host_ms);
  return {};
}

}  // namespace

std::string doubt_about(const TimedLoad& light, const TimedLoad& heavy) {
  for (const TimedLoad* load : {&light, &heavy}) {
    if (std::string doubt = doubt_about(*load); !doubt.empty()) return doubt;
  }
  const double grown = duration_ms(heavy.stamps) - duration_ms(light.stamps);
  const double host_grown = heavy.host_ms - light.host_ms;
  if (grown > 0 && grown >= kLeastGrowth * host_grown) return {};
  return fmt::format("with {} times the work they grow by {:.3f} ms, where the host saw {:.3f} ms",
                     kHeavyLoad, grown, host_grown);
}

}  // namespace quincunx
