// SPDX-License-Identifier: MIT
#include "tools/diagnose/diagnose.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

bool has_fault(const Finding& finding, const std::string& fault) {
  return std::find(finding.faults.begin(), finding.faults.end(), fault) != finding.faults.end();
}

FailureMap failure_map(Frames frames, const DiagnosedInput& input, const std::vector<Plane>& planes,
                       std::size_t now) {
  const DiagnosedFrame &frame = frames[now], &last = frames[now - 1];
  FailureMap map = {frame.number, frame.render, planes[now].values};
  Pair row = pair_of(frames, now);  // of a picture's rows, one after another
  const Vec2 shift = shift_of(row, frame.jitter, last.jitter);
  for (int y = 0; y < frame.render.height; ++y) {
    row.places.clear();
    for (int x = 0; x < frame.render.width; ++x) {
      const std::size_t at = pixel_of(frame, x, y);
      Place place = {.x = x, .y = y, .light = map.light[at]};
      if (!frame.velocity.empty()) place.velocity[1] = frame.velocity[at];
      row.places.push_back(place);
    }
    const Motion motion = motion_of(row, input, {}, frame.render);
    for (const float square : foretell(row, planes[now - 1], motion, shift)) {
      map.error.push_back(std::sqrt(square) / kMostError);
      map.mean += map.error.back() / static_cast<double>(frame.render.area());
    }
  }
  return map;
}

// Returns the frames that have a frame `later` after them, with its motion.
std::vector<DiagnosedFrame> with_motion_of(Frames frames, int later) {
  std::vector<DiagnosedFrame> aligned;
  for (std::size_t i = later < 0 ? 1 : 0; i + (later > 0 ? 1 : 0) < frames.size(); ++i) {
    const std::size_t other = later > 0 ? i + 1 : i - 1;
    aligned.push_back(frames[i]);
    if (follows(frames, std::max(i, other)) && frames[other].render == frames[i].render)
      aligned.back().velocity = frames[other].velocity;
  }
  return aligned;
}

void add_lateness(Finding& velocity, const Lateness& lateness) {
  const MotionGuess late = {.later = lateness.later};
  if (velocity.verdict != Verdict::kWrong) weigh(velocity, {});
  velocity.verdict = Verdict::kWrong;
  velocity.faults.emplace_back("frame");
  velocity.fits += (velocity.fits.empty() ? "" : ", ") + text_of(late);
  velocity.share = lateness.share;
  velocity.option += (velocity.option.empty() ? "" : ", ") + option_of({}, late, {});
  std::erase(velocity.open, "frame");
}

// Dilated motion is that of a pixel beside: it differs from the camera's by about as much as that of another frame.
void doubt_frame(Finding& camera) {
  if (has_fault(camera, "frame"))
    camera = {.subject = camera.subject, .says = camera.says, .open = {"frame"}};
}

// `shapes`: pairs of depth. `cuts`: frames before which cuts are missing; that finding is the last.
Diagnosis examine(Frames frames, const DiagnosedInput& input, const Form& form,
                  const std::vector<Plane>& planes, const std::vector<Pair>& pairs,
                  const std::vector<Pair>& shapes, std::vector<std::int64_t>& cuts) {
  std::vector<Pair> all = pairs;
  all.insert(all.end(), shapes.begin(), shapes.end());
  const MotionAnswer motion = find_motion(frames, input, form, planes, all);
  const Scene scene = {frames, input, form, planes, pairs, motion, light_scale(frames)};
  Diagnosis diagnosis = {motion.findings, motion.mend};
  const DepthGuess depth = find_depth(scene, diagnosis.findings);
  if (!has_fault(motion.findings.front(), "frame")) {  // which lies beside its surfaces
    const Finding dilation = find_dilation(scene, depth.kind);
    if (has_fault(dilation, "dilated") || (input.dilated && dilation.verdict == Verdict::kRight))
      doubt_frame(diagnosis.findings.back());
    diagnosis.findings.push_back(dilation);
  }
  diagnosis.findings.push_back(find_resolution(scene));
  const bool coarse = diagnosis.findings.back().verdict == Verdict::kWrong;
  diagnosis.findings.push_back(find_sky(scene, depth));
  diagnosis.findings.push_back(find_objects(scene, depth, coarse));
  diagnosis.findings.push_back(find_encoding(scene));
  diagnosis.findings.push_back(find_filter(scene, depth.kind));
  find_light(scene, diagnosis.findings, cuts);
  return diagnosis;
}

// With motion that belongs to the frames it is with.
Diagnosis diagnose_aligned(Frames frames, const DiagnosedInput& input, const Form& form) {
  if (frames.empty()) return {};
  std::vector<Plane> planes = planes_of(frames);
  std::vector<Pair> pairs = pairs_of(frames, planes), shapes = add_shapes(frames, input, planes);
  std::vector<std::int64_t> cuts;
  Diagnosis diagnosis = examine(frames, input, form, planes, pairs, shapes, cuts);
  if (cuts.empty()) return diagnosis;
  // Once more without what is no pair; that there are cuts remains.
  const Finding found = diagnosis.findings.back();
  for (std::vector<Pair>* of_cuts : {&pairs, &shapes}) {
    std::erase_if(*of_cuts, [&](const Pair& pair) {
      return std::find(cuts.begin(), cuts.end(), frames[pair.now].number) != cuts.end();
    });
  }
  diagnosis = examine(frames, input, form, planes, pairs, shapes, cuts);
  diagnosis.findings.back() = found;
  return diagnosis;
}

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr const char* kNames[] = {"right", "wrong", "cannot tell"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Vec2 JitterMend::of(Vec2 told) const {
  return product(swapped ? Vec2{told.y, told.x} : told, factors);
}

bool Diagnosis::wrong() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.verdict == Verdict::kWrong; });
}

std::vector<FailureMap> failure_maps(Frames frames, const DiagnosedInput& input, std::size_t most) {
  std::vector<FailureMap> maps;
  const std::vector<Plane> planes = planes_of(frames);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (!follows(frames, i)) continue;
    maps.push_back(failure_map(frames, input, planes, i));
    std::sort(maps.begin(), maps.end(), [](const auto& a, const auto& b) { return a.mean > b.mean; });
    if (maps.size() > most) maps.pop_back();
  }
  return maps;
}

Diagnosis diagnose(Frames frames, const DiagnosedInput& said) {
  if (frames.empty()) return {};
  Form form = form_of(frames, said);
  std::vector<DiagnosedFrame> ranged;
  if (form.range != kWholeRange) {
    ranged.assign(frames.begin(), frames.end());
    for (DiagnosedFrame& frame : ranged)
      scale_depth(form.range, DepthKind::kDeviceReversed, frame.depth);
    frames = ranged;
    form.kind = form_of(frames, said).kind;
  }
  DiagnosedInput input = said;
  input.depth_kind = form.kind.value_or(said.depth_kind);
  const Lateness lateness = find_lateness(frames, input);
  if (lateness.later == 0) {
    Diagnosis diagnosis = diagnose_aligned(frames, input, form);
    if (lateness.known) std::erase(diagnosis.findings.front().open, "frame");
    return diagnosis;
  }
  Diagnosis diagnosis = diagnose_aligned(with_motion_of(frames, lateness.later), input, form);
  if (!diagnosis.findings.empty()) add_lateness(diagnosis.findings.front(), lateness);
  return diagnosis;
}

}  // namespace quincunx::tools