// SPDX-License-Identifier: MIT
// JitterSource: where the jitter of a sequence's frames comes from. Thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "quincunx/status.h"
#include "tools/program/jitter.h"
#include "tools/record/exchange_attributes.h"

namespace quincunx::tools {

// A value.
class JitterSource {
 public:
  // `text`: "attribute", a pattern ("none", "quincunx", "quincunx-half", "halton"), or a file: lines of
  // FRAME X Y (spaces or commas between, # starts a comment), or JSON with per_frame: [{frame, jitter: [X,
  // Y]}, ...] as in sequence.json. Empty: the attribute where the sequence has one, else none. Errors:
  // kInvalidArgument for a name that is neither, kIoFailure for a bad file.
  static Result<JitterSource> parse(const std::string& text);

  // Decides what an empty text left open, by the attributes of the first frame.
  void settle(const FrameAttributes& first);

  // `number`: the file's. Patterns count by the attribute frameIndex where there is one.
  // Errors: kIoFailure where neither attribute nor file knows the frame, or what they say lies beyond [-1, 1]; the
  // message names `path`.
  Result<Vec2> at(const std::string& path, std::int64_t number, const FrameAttributes& attributes,
                  Extent render, Extent output) const;

  const std::string& text() const { return text_; }

 private:
  struct Automatic {};
  struct FromAttribute {};
  using Table = std::map<std::int64_t, Vec2>;

  std::string text_;
  std::variant<Automatic, FromAttribute, Jitter, std::shared_ptr<const Table>> source_;
};

}  // namespace quincunx::tools
