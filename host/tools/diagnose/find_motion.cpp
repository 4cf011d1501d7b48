// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tools/diagnose/findings.h"

namespace quincunx::tools {
namespace {

class Search {
 public:
  Search(Frames frames, const DiagnosedInput& input, const std::vector<Plane>& planes,
         const std::vector<Pair>& pairs)
      : frames_(frames), input_(input), planes_(planes), pairs_(pairs) {}

  std::vector<Motion> motion(const MotionGuess& guess) const {
    std::vector<Motion> motion;
    for (const Pair& pair : pairs_)
      motion.push_back(motion_of(pair, input_, guess, frames_[pair.now].render));
    return motion;
  }

  // With a stride, at every so many places only.
  Foretold foretold(const std::vector<Motion>& motion, const JitterGuess& jitter, int later = 0,
                    std::size_t stride = 1) const {
    Foretold result = {.motion = &motion,
                       .shift = std::vector<Vec2>(pairs_.size()),
                       .errors = std::vector<std::vector<float>>(pairs_.size())};
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const Pair& pair = pairs_[p];
      const auto now = jitter_at(frames_, input_, jitter, pair.now);
      const auto before = jitter_at(frames_, input_, jitter, pair.now - 1);
      if (!now || !before || (later > 0 && !pair.has_next) || (later < 0 && !pair.has_second)) continue;
      result.shift[p] = shift_of(pair, *now, *before);
      result.errors[p] = foretell(pair, planes_[pair.before], motion[p], result.shift[p], stride);
    }
    return result;
  }

  // Mean over the places that stay within the picture, with the shifts of `like`: else shorter motion would win.
  double inside_error(const std::vector<Motion>& motion, const Foretold& like) const {
    double sum = 0, count = 0;
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      if (like.errors[p].empty()) continue;
      const std::vector<float> light =
          foretold_light(pairs_[p], planes_[pairs_[p].before], motion[p], like.shift[p]);
      for (std::size_t i = 0; i < light.size(); ++i) {
        if (light[i] < 0) continue;
        const float error = std::min(std::abs(light[i] - pairs_[p].places[i].light), kMostError);
        sum += error * error, count += 1;
      }
    }
    return count > 0 ? sum / count : 1;
  }

  std::size_t places() const {
    std::size_t sum = 0;
    for (const Pair& pair : pairs_)
      sum += pair.places.size();
    return sum;
  }

  Comparison compared(const Foretold& one, const Foretold& other) const {
    return compare(pairs_, frames_, one, other);
  }

 private:
  Frames frames_;
  const DiagnosedInput& input_;
  const std::vector<Plane>& planes_;
  const std::vector<Pair>& pairs_;
};

// How much of a jitter's steps is in the motion, at places all over the picture: -1 where each position is that in its
// jittered picture. Motion itself changes smoothly, jitter does not. Where surfaces change it is any number.
std::vector<double> jitter_factors(Frames frames, const DiagnosedInput& input, const MotionGuess& guess,
                                   const JitterGuess& jitter) {
  constexpr int kAcross = 40;
  std::vector<double> factors;
  const Extent extent = frames[0].render;
  const Vec2 scale = factors_of(input, guess, extent);
  std::vector<std::optional<Vec2>> steps(frames.size());
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const auto now = jitter_at(frames, input, jitter, i), before = jitter_at(frames, input, jitter, i - 1);
    if (now && before) steps[i] = difference(*now, *before);
  }
  for (int cell = 0; cell < kAcross * kAcross; ++cell) {
    const int x = (2 * (cell % kAcross) + 1) * extent.width / (2 * kAcross);
    const int y = (2 * (cell / kAcross) + 1) * extent.height / (2 * kAcross);
    const std::size_t pixel = pixel_of(frames[0], x, y);
    const auto at = [&](std::size_t f) {
      Vec2 v = frames[f].velocity[pixel];
      if (guess.swapped) std::swap(v.x, v.y);
      return product(v, scale);
    };
    const auto usable = [&](std::size_t f) {
      if (!steps[f] || frames[f].render != extent || frames[f].velocity.empty() || frames[f].reset)
        return false;
      const Vec2 v = frames[f].velocity[pixel];
      return std::isfinite(v.x) && std::isfinite(v.y) && v != Vec2{};
    };
    double product = 0, square = 0;
    for (std::size_t f = 2; f + 1 < frames.size(); ++f) {
      if (!usable(f - 1) || !usable(f) || !usable(f + 1)) continue;
      const Vec2 a = at(f - 1), b = at(f), c = at(f + 1), p = *steps[f - 1], q = *steps[f], r = *steps[f + 1];
      const double jx = r.x - 2 * q.x + p.x, jy = r.y - 2 * q.y + p.y;
      const double mx = c.x - 2 * b.x + a.x, my = c.y - 2 * b.y + a.y;
      if (std::hypot(mx, my) > 2 * std::hypot(jx, jy) + .5) continue;  // another surface has come here
      product += mx * jx + my * jy;
      square += jx * jx + jy * jy;
    }
    if (square > 0) factors.push_back(product / square);
  }
  return factors;
}

// Returns the jitter whose steps are in the motion, if one is: as told, or else the one that most places tell.
std::optional<JitterGuess> jitter_in_motion(Frames frames, const DiagnosedInput& input,
                                            const MotionGuess& guess,
                                            const std::vector<JitterGuess>& jitters) {
  std::optional<JitterGuess> found;
  std::ptrdiff_t most = 0;
  for (const JitterGuess& jitter : jitters) {
    if (jitter.factor == 0) continue;
    const std::vector<double> factors = jitter_factors(frames, input, guess, jitter);
    const auto near = [&](double value) {
      constexpr double kRoom = .2;
      return std::count_if(factors.begin(), factors.end(),
                           [&](double f) { return std::abs(f - value) < kRoom; });
    };
    const auto votes = near(-1);
    if (factors.size() < 50 || votes * 4 <= static_cast<std::ptrdiff_t>(factors.size()) ||
        votes <= 4 * near(0) || votes <= 4 * near(1))
      continue;
    if (jitter == JitterGuess{}) return jitter;
    if (jitter.pattern && found) continue;  // the last that one would think of
    if (votes > most) most = votes, found = jitter;
  }
  return found;
}

// Returns what might be mistaken for a guess.
std::vector<MotionGuess> toggled(const MotionGuess& guess) {
  std::vector<MotionGuess> rivals(8, guess);
  rivals[0].flip_x = !guess.flip_x;
  rivals[1].flip_y = !guess.flip_y;
  rivals[2].flip_x = !guess.flip_x, rivals[2].flip_y = !guess.flip_y;
  rivals[3].swapped = !guess.swapped;
  rivals[4].unit = Unit::kNothing;
  rivals[5].unit = Unit::kOutputPixels, rivals[5].length = {1, 1};
  rivals[6].length = product(guess.length, {2, 2});
  rivals[7].length = product(guess.length, {.5f, .5f});
  for (const int later : {-1, 1}) {
    rivals.push_back(guess);
    rivals.back().later = guess.later == later ? 0 : later;
  }
  return rivals;
}

// What depth and camera, as the input says them, say of motion, whether or not it foretells.
struct CameraWord {
  std::optional<MotionGuess> guess = {};  // nothing where motion is not the camera's under any
  std::vector<Comparison> over = {};      // its toggled() rivals, in their order
};

CameraWord word_of_camera(const Search& search, const DiagnosedInput& input, Extent extent,
                          const std::vector<Pair>& pairs, Frames frames, const std::vector<Motion>& camera) {
  const auto apart = [&](const std::vector<Motion>& motion) {
    Foretold result = {.motion = &motion,
                       .apart = .05f,
                       .shift = std::vector<Vec2>(pairs.size()),
                       .errors = std::vector<std::vector<float>>(pairs.size())};
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      for (std::size_t i = 0; i < camera[p].size(); ++i) {
        const bool drawn = pairs[p].places[i].velocity[1] != Vec2{};
        const float off = square(difference(motion[p][i], camera[p][i]));
        result.errors[p].push_back(drawn ? std::min(off, 1.0f) : 0);
      }
    }
    return result;
  };
  std::vector<MotionGuess> guesses = motion_guesses(input, extent);
  // A near plane elsewhere makes motion longer or shorter, too.
  const bool lengths = input.depth_kind == DepthKind::kLinear;
  std::erase_if(guesses, [&](const MotionGuess& guess) {
    return guess.later != 0 || (!keeps_unit(guess) && !lengths);
  });
  std::vector<std::vector<Motion>> fields;
  for (const MotionGuess& guess : guesses)
    fields.push_back(search.motion(guess));
  std::vector<Candidate> candidates;
  for (std::size_t g = 0; g < guesses.size(); ++g)
    candidates.push_back({faults_of(guesses[g]).size(), g, apart(fields[g])});
  const std::size_t chosen = choose(pairs, frames, candidates);
  const Foretold& best = candidates[chosen].foretold;
  if (!agrees(pairs, fields[chosen], camera)) return {};
  CameraWord word = {.guess = guesses[chosen]};
  for (const MotionGuess& rival : toggled(*word.guess)) {
    const std::vector<Motion> field = search.motion(rival);
    word.over.push_back(compare(pairs, frames, best, apart(field)));
  }
  return word;
}

// All guesses, foretold, and the one to believe.
struct Guesses {
  std::vector<MotionGuess> motions;
  std::vector<JitterGuess> jitters;
  std::vector<std::vector<Motion>> fields;  // of the motions
  std::vector<Candidate> candidates;        // every motion with every jitter; the hopeless without errors
  std::size_t chosen = 0;

  std::size_t index(std::size_t m, std::size_t j) const { return m * jitters.size() + j; }
  std::size_t chosen_motion() const { return chosen / jitters.size(); }
  std::size_t chosen_jitter() const { return chosen % jitters.size(); }
  const MotionGuess& motion() const { return motions[chosen_motion()]; }
  const JitterGuess& jitter() const { return jitters[chosen_jitter()]; }
  const Foretold& best() const { return candidates[chosen].foretold; }
  bool told() const { return jitters.size() > 4; }  // of a jitter: guesses are more than none and patterns
};

double mean_error(const Foretold& foretold) {
  double sum = 0, n = 0;
  for (const std::vector<float>& errors : foretold.errors) {
    sum = std::accumulate(errors.begin(), errors.end(), sum);
    n += static_cast<double>(errors.size());
  }
  return n > 0 ? sum / n : 1;
}

// Whether one foretells worse than the other by far more than chance makes of some thousand places.
bool hopeless(const Foretold& one, const Foretold& other) {
  constexpr double kSure = 5;  // standard errors: neighbours err together
  double sum = 0, squares = 0;
  for (std::size_t p = 0; p < one.errors.size(); ++p) {
    for (std::size_t i = 0; i < std::min(one.errors[p].size(), other.errors[p].size()); ++i) {
      const double more = static_cast<double>(one.errors[p][i]) - static_cast<double>(other.errors[p][i]);
      sum += more, squares += more * more;
    }
  }
  return sum > kSure * std::sqrt(squares);
}

// What is asked of a candidate that was hopeless, too.
const Foretold& foretold(const Search& search, Guesses& guesses, std::size_t m, std::size_t j) {
  Foretold& known = guesses.candidates[guesses.index(m, j)].foretold;
  if (known.errors.empty())
    known = search.foretold(guesses.fields[m], guesses.jitters[j], guesses.motions[m].later);
  return known;
}

void foretell_all(const Search& search, Guesses& guesses) {
  constexpr std::size_t kEnough = 5000;  // places, to find the hopeless
  const std::size_t stride = std::max<std::size_t>(search.places() / kEnough, 1);
  for (const MotionGuess& guess : guesses.motions)
    guesses.fields.push_back(search.motion(guess));
  std::vector<Foretold> samples;
  std::vector<double> means;
  for (std::size_t m = 0; m < guesses.motions.size(); ++m) {
    for (const JitterGuess& jitter : guesses.jitters) {
      // A pattern in place of what is told is the last that one would think of.
      const std::size_t strange = jitter.pattern && guesses.told() ? 1 : 0;
      guesses.candidates.push_back(
          {strange + faults_of(guesses.motions[m]).size() + faults_of(jitter).size(), m, {}});
      samples.push_back(search.foretold(guesses.fields[m], jitter, guesses.motions[m].later, stride));
      means.push_back(mean_error(samples.back()));
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    std::size_t best = i;
    for (std::size_t other = 0; other < samples.size(); ++other) {
      const bool simpler = guesses.candidates[other].faults <= guesses.candidates[i].faults;
      if (simpler && means[other] < means[best]) best = other;
    }
    if (!hopeless(samples[i], samples[best]))
      foretold(search, guesses, i / guesses.jitters.size(), i % guesses.jitters.size());
  }
}

// Believes motion in another unit only where it foretells better than none.
void choose_guess(const Search& search, const std::vector<Pair>& pairs, Frames frames, Guesses& guesses) {
  guesses.chosen = choose(pairs, frames, guesses.candidates);
  if (keeps_unit(guesses.motion())) return;
  const std::vector<Motion> rest = at_rest(pairs);
  if (clear(search.compared(guesses.best(), search.foretold(rest, guesses.jitter())))) return;
  for (std::size_t m = 0; m < guesses.motions.size(); ++m) {
    for (std::size_t j = 0; j < guesses.jitters.size(); ++j)
      if (!keeps_unit(guesses.motions[m])) guesses.candidates[guesses.index(m, j)].foretold = {};
  }
  guesses.chosen = choose(pairs, frames, guesses.candidates);
}

// Fits a length that was guessed more closely, with the jitter that is believed.
void fit_length(const Search& search, Guesses& guesses) {
  const std::size_t m = guesses.chosen_motion();
  MotionGuess& guess = guesses.motions[m];
  if (guess.length == simple(product(guess.length, {1.001f, 1.001f}), .01f)) return;  // which is a simple one
  double least = search.inside_error(guesses.fields[m], guesses.best());
  for (const float step : {.12f, .06f, .03f, .015f, .008f}) {
    for (const Vec2 axes : {Vec2{1, 1}, {-1, -1}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      MotionGuess other = guess;
      other.length = product(guess.length, {std::exp2(step * axes.x), std::exp2(step * axes.y)});
      const double error = search.inside_error(search.motion(other), guesses.best());
      if (error < least) least = error, guess = other;
    }
  }
  guess.length = simple(guess.length, .01f);
  guesses.fields[m] = search.motion(guess);
  for (std::size_t j = 0; j < guesses.jitters.size(); ++j)
    guesses.candidates[guesses.index(m, j)].foretold = {};
  foretold(search, guesses, m, guesses.chosen_jitter());
}

// Believes the camera instead where the frames do not say clearly otherwise, or only by more faults.
void heed_camera(const Search& search, const std::vector<Pair>& pairs, Frames frames, const CameraWord& word,
                 Guesses& guesses) {
  if (!word.guess || *word.guess == guesses.motion()) return;
  const auto known = std::find(guesses.motions.begin(), guesses.motions.end(), *word.guess);
  const auto m = static_cast<std::size_t>(known - guesses.motions.begin());
  if (known == guesses.motions.end()) return;
  std::vector<Candidate> candidates;
  for (std::size_t j = 0; j < guesses.jitters.size(); ++j) {
    candidates.push_back(guesses.candidates[guesses.index(m, j)]);
    candidates.back().faults -= faults_of(*known).size();
    candidates.back().foretold = foretold(search, guesses, m, j);
  }
  const std::size_t j = choose(pairs, frames, candidates);
  if (!clear(search.compared(guesses.best(), candidates[j].foretold))) guesses.chosen = guesses.index(m, j);
}

// Returns how the chosen motion compares with those that may be mistaken for it.
Rivals rivals_of_motion(const Search& search, const DiagnosedInput& input, const Guesses& guesses,
                        const CameraWord& word, Extent extent) {
  const MotionGuess& motion = guesses.motion();
  const std::vector<MotionGuess> toggles = toggled(motion);
  Rivals rivals;
  for (std::size_t r = 0; r < toggles.size(); ++r) {
    const MotionGuess& rival = toggles[r];
    if (same(input, rival, motion, extent)) continue;
    const std::vector<Motion> field = search.motion(rival);
    MotionGuess change = rival;
    change.flip_x ^= motion.flip_x, change.flip_y ^= motion.flip_y, change.swapped ^= motion.swapped;
    if (rival.unit == motion.unit) change.unit = Unit::kStated;
    if (rival.length == motion.length) change.length = {1, 1};
    change.rest = {};
    if (rival.later == motion.later) change.later = 0;
    const Comparison compared =
        search.compared(guesses.best(), search.foretold(field, guesses.jitter(), rival.later));
    // Whose motion it is says nothing of what it means.
    if (change.later != 0 && clear(compared)) continue;
    const bool by_camera = word.guess == motion && change.later == 0 && !clear(compared);
    rivals.add(by_camera ? word.over[r] : compared, faults_of(change));
  }
  return rivals;
}

// `mixed`: the jitter is in the motion though that is not said, or is not though it is.
Finding judge_motion(const Search& search, const DiagnosedInput& input, Guesses& guesses,
                     const CameraWord& word, bool mixed, Extent extent) {
  const MotionGuess& motion = guesses.motion();
  Finding finding = {.subject = "velocity", .says = tools::name_of(input.units.convention)};
  const Rivals rivals = rivals_of_motion(search, input, guesses, word, extent);
  rivals.judge(finding);
  if (motion == MotionGuess{} && !mixed) return finding;
  finding.verdict = Verdict::kWrong;
  finding.faults = faults_of(motion);
  finding.fits = text_of(motion);
  if (motion != MotionGuess{}) finding.option = option_of(input, motion, extent);
  if (mixed) {
    const bool said = input.units.jittered;
    finding.faults.emplace_back(said ? "no jitter in it" : "jitter in it");
    finding.fits += finding.fits.empty() ? "" : ", ";
    finding.fits += said ? "without the jitter in it" : "with the jitter in it";
    if (!finding.option.empty()) finding.option += said ? ", " : " ";
    finding.option += said ? "no --velocity-jittered" : "--velocity-jittered";
  }
  const std::size_t jitter = motion == MotionGuess{} ? 0 : guesses.chosen_jitter();
  weigh(finding, search.compared(guesses.best(), foretold(search, guesses, 0, jitter)));
  return finding;
}

// `jitter`: the one that fits. Where the motion holds it, pictures cannot tell it from none: the motion's word counts.
Finding judge_jitter(const Search& search, Guesses& guesses, const JitterGuess& jitter, bool mixed) {
  Finding finding = {.subject = "jitter", .says = guesses.told() ? "told" : "none"};
  if (jitter == JitterGuess{}) {
    Rivals rivals;
    for (std::size_t j = 1; j < guesses.jitters.size() && !mixed; ++j) {
      if (guesses.jitters[j].pattern && guesses.told()) continue;
      const Foretold& rival = foretold(search, guesses, guesses.chosen_motion(), j);
      rivals.add(search.compared(guesses.best(), rival), faults_of(guesses.jitters[j]));
    }
    rivals.judge(finding);
    if (mixed) finding.verdict = Verdict::kRight;
    return finding;
  }
  finding.verdict = Verdict::kWrong;
  finding.faults = faults_of(jitter);
  finding.fits = text_of(jitter);
  finding.option = jitter.pattern       ? fmt::format("--jitter {}", tools::name_of(*jitter.pattern))
                   : jitter.factor == 0 ? "--jitter none"
                                        : "--jitter FILE, with what --diagnose --json prints";
  weigh(finding, search.compared(guesses.best(), foretold(search, guesses, guesses.chosen_motion(), 0)));
  return finding;
}

}  // namespace

MotionAnswer find_motion(Frames frames, const DiagnosedInput& input, const Form& form,
                         const std::vector<Plane>& planes, const std::vector<Pair>& pairs) {
  const Search search(frames, input, planes, pairs);
  const bool has_motion = !frames[0].velocity.empty();
  const Extent extent = frames[0].render;
  Guesses guesses;
  guesses.motions = {{}};
  guesses.jitters = jitter_guesses(frames, input);
  CameraWord word;
  if (has_motion) {
    word = word_of_camera(search, input, extent, pairs, frames,
                          stated_camera_motion(frames, input, form, planes, pairs));
    guesses.motions = best_guesses(frames, input, planes, pairs, word.guess.has_value());
    const auto& known = guesses.motions;
    if (word.guess && std::find(known.begin(), known.end(), *word.guess) == known.end())
      guesses.motions.push_back(*word.guess);
  }
  foretell_all(search, guesses);
  choose_guess(search, pairs, frames, guesses);
  fit_length(search, guesses);
  heed_camera(search, pairs, frames, word, guesses);

  MotionAnswer answer = {.motion = guesses.fields[guesses.chosen_motion()], .shift = guesses.best().shift};
  JitterGuess jitter = guesses.jitter();
  bool mixed = false;
  if (has_motion) {
    const auto within = jitter_in_motion(frames, input, guesses.motion(), guesses.jitters);
    // What was said to be in it was taken out before: of motion without it that leaves the opposite.
    const bool said = input.units.jittered;
    mixed = within && (!said || *within == JitterGuess{.flip_x = true, .flip_y = true});
    if (mixed) jitter = said ? JitterGuess{} : *within;
  }
  Finding motion = {.subject = "velocity", .says = "none"};
  if (has_motion) motion = judge_motion(search, input, guesses, word, mixed, extent);
  const Finding moved = judge_jitter(search, guesses, jitter, mixed);
  answer.findings = {motion, moved};
  answer.knows_motion = motion.verdict != Verdict::kUnknown;
  answer.mend = mend_of(jitter);
  answer.guess = guesses.motion();
  answer.jitters = !mixed ? 0 : input.units.jittered ? -1.0f : 1.0f;
  for (std::size_t i = 0; i < frames.size(); ++i)
    answer.jitter.push_back(jitter_at(frames, input, jitter, i).value_or(frames[i].jitter));
  return answer;
}

Vec2 own_motion(const Scene& scene, const Pair& pair, int x, int y) {
  const DiagnosedFrame& frame = scene.frames[pair.now];
  const MotionGuess& guess = scene.motion.guess;
  Vec2 v = difference(frame.velocity[pixel_of(frame, x, y)], guess.rest);
  if (guess.swapped) std::swap(v.x, v.y);
  const Vec2 moved = product(v, factors_of(scene.input, guess, frame.render));
  const Vec2 step = difference(scene.motion.jitter[pair.now], scene.motion.jitter[pair.now - 1]);
  return {moved.x + scene.motion.jitters * step.x, moved.y + scene.motion.jitters * step.y};
}

}  // namespace quincunx::tools
