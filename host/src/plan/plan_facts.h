// SPDX-License-Identifier: MIT
// PlanFacts: what passes ask of a plan: the scene's needs, the settings, and what follows from both.
#pragma once

#include "plan/resources.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

// A value; pure.
struct PlanFacts {
  PlanFacts(const SceneNeeds& scene_needs, const ResolveSettings& resolve_settings);

  SceneNeeds needs;
  ResolveSettings settings;
  VelocitySource velocity;  // where passes find it; kNone where no pass reads it
  bool two_way = false;  // history is merged with that of later frames before it is shown (passes/two_way.h)

  bool has_velocity() const { return velocity != VelocitySource::kNone; }
  // Colour is what the screen shall show: the renderer has exposed, tone mapped and encoded it.
  bool is_display_referred() const { return settings.colour == PixelFormat::kRGBA8; }
  bool reads_velocity() const;  // some pass after those that complete the frame
  bool overlays_particles() const { return settings.targets.particle_extent != Extent(); }
  bool fills() const { return settings.targets.shading == Shading::kCheckerboard; }
  bool accumulates() const { return settings.method == Method::kTemporal; }
  bool resolves_two_frames() const { return settings.method == Method::kQuincunx; }
  bool keeps_previous_frame() const { return uses_earlier_frames(settings.method); }
  bool has_form(TwoFrameForm form) const { return resolves_two_frames() && settings.quincunx.form == form; }
  bool weighs_velocity() const { return has_velocity() && has_form(TwoFrameForm::kVelocity); }
  bool reprojects() const {  // where each sample was in the previous frame is computed
    return has_velocity() && (accumulates() || has_form(TwoFrameForm::kReprojected));
  }
  bool weighs_residual() const {
    return reprojects() && !accumulates() && settings.quincunx.residual_weight > 0;
  }
  bool undilates_velocity() const {
    return settings.conventions.drawn_velocity == DrawnVelocity::kDilated &&
           velocity == VelocitySource::kTarget && reads_velocity();
  }
  bool moves_sky() const {  // the drawn velocity of what is infinitely far away is completed
    const bool possible = settings.conventions.sky_motion != SkyMotion::kEvidence || keeps_previous_frame();
    return settings.conventions.sky_motion != SkyMotion::kAsDrawn && velocity == VelocitySource::kTarget &&
           reads_velocity() && needs.camera_motion && possible;
  }
  bool fits_sky() const { return moves_sky() && settings.conventions.sky_motion == SkyMotion::kEvidence; }
  bool reads_reactive() const { return (keeps_previous_frame() || measures_content()) && needs.transparents; }
  bool measures_content() const { return settings.control.measures_content && has_velocity(); }
  bool checks_motion() const {
    return settings.checks_motion && velocity == VelocitySource::kTarget && reads_velocity() &&
           keeps_previous_frame();
  }
  bool shows_picture() const {  // and no debug view
    return !accumulates() || settings.temporal.view == TemporalView::kPicture;
  }
  bool views_layers() const {
    const TemporalView view = settings.temporal.view;
    return accumulates() && (view == TemporalView::kLayers || view == TemporalView::kCoverage ||
                             view == TemporalView::kNear || view == TemporalView::kFar);
  }
  bool displays_history() const { return accumulates() && (shows_picture() || views_layers()); }
  bool has_layers() const {  // a second layer of history where surfaces move apart
    return displays_history() && reprojects() && settings.temporal.preset != TemporalPreset::kFast;
  }
  // The picture of history is sharpened, and smoothed along edges. Both ways it takes a small part of the time.
  bool refines() const {
    const TemporalPreset preset = settings.temporal.preset;
    return accumulates() && shows_picture() &&
           (preset == TemporalPreset::kQuality || (two_way && preset == TemporalPreset::kBalanced));
  }
  bool denoises() const { return accumulates() && shows_picture() && settings.temporal.noise > 0; }
  bool smooths_history() const {  // where little is known, on all sides; temporal_refine does it along edges
    return displays_history() && settings.temporal.preset != TemporalPreset::kFast && !refines();
  }
  bool resizes_history() const { return is_dual() && accumulates(); }
  bool accumulates_alpha() const { return shows_picture() && accumulates() && !needs.background; }
  // Some pass has rules of exposed light.
  bool exposes() const {
    return accumulates() || has_form(TwoFrameForm::kReprojected) || sharpens() || fits_sky();
  }
  bool sharpens() const { return settings.sharpness > 0 && shows_picture(); }
  bool has_focus() const { return settings.focus.extent != Extent{} && shows_picture(); }
  bool blurs() const { return settings.blur.shutter > 0 && has_velocity(); }
  bool is_dual() const {
    return settings.output.min_extent != settings.output_extent;
  }  // the output is dynamic
  // Whether a viewport may be larger than an output on an axis, or dense.
  bool may_widen() const;
  bool may_be_dense() const;
  bool places_targets() const { return settings.targets.placement == Targets::kPlaced; }
  Storage presented_storage() const { return places_targets() ? Storage::kBuffer : settings.targets.storage; }
};

// Whether the temporal upscaler's samples are so dense, from 1.56 a pixel on, that a frame alone is the better
// picture.
bool is_dense(Extent render, Extent output);

// Whether a viewport is larger than the output on an axis, so that filters widen.
bool widens(Extent render, Extent output);

// Returns the plan's storage for inputs, whoever makes them, and for the presented picture; all else is in buffers.
Storage storage_of(Resource resource, const PlanFacts& facts);

// The velocity that undilate_velocity writes, and that resolve_checkerboard does.
inline Resource drawn_velocity_of(const PlanFacts& facts) {
  return facts.moves_sky() ? Resource::kDrawnVelocity : Resource::kVelocity;
}
inline Resource filled_velocity_of(const PlanFacts& facts) {
  return facts.undilates_velocity() ? Resource::kDilatedVelocity : drawn_velocity_of(facts);
}

// The picture that the method makes, before sharpening.
inline Resource picture_of(const PlanFacts& facts) {
  return facts.sharpens() ? Resource::kUnsharpened : Resource::kResolved;
}

// The picture of the history, before the preset `quality` refines it, and before it is denoised.
inline Resource denoised_of(const PlanFacts& facts) {
  return facts.refines() ? Resource::kUnrefined : picture_of(facts);
}
inline Resource shown_history_of(const PlanFacts& facts) {
  return facts.denoises() ? Resource::kNoisy : denoised_of(facts);
}

// The picture of this direction's history alone, and the history that is shown.
inline Resource centred_of(const PlanFacts& facts) {
  return facts.two_way ? Resource::kCentred : shown_history_of(facts);
}
inline Resource displayed_history_of(const PlanFacts& facts) {
  return facts.two_way ? Resource::kMergedHistory : Resource::kHistory;
}

// The picture with all that is made of it, in the output's size, and the one that is shown.
inline Resource finished_of(const PlanFacts& facts) {
  return facts.blurs() ? Resource::kBlurred : Resource::kResolved;
}
inline Resource shown_of(const PlanFacts& facts) {
  return facts.is_dual() ? Resource::kDisplayed : finished_of(facts);
}

}  // namespace quincunx
