// SPDX-License-Identifier: MIT
#include "tools/sequence/sequence_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <string_view>

#include "tools/program/lower_case.h"

namespace quincunx::tools {
namespace {

// The parts of a name that are not empty, with dots between.
std::string dotted(std::initializer_list<std::string_view> parts) {
  std::string name;
  for (const std::string_view part : parts)
    name += part.empty() ? "" : fmt::format("{}{}", name.empty() ? "" : ".", part);
  return name;
}

// Takes the word out of a name, with the mark that parted it, in any case of letters; returns whether it was there.
bool take_out(const std::string& word, std::string& name) {
  constexpr std::string_view kMarks = "._- ";
  const std::string in = in_lower_case(name), wanted = in_lower_case(word);
  for (std::size_t at = in.find(wanted); at != std::string::npos; at = in.find(wanted, at + 1)) {
    const std::size_t end = at + wanted.size();
    const bool begins = at == 0 || kMarks.find(in[at - 1]) != std::string_view::npos;
    if (!begins || (end < in.size() && kMarks.find(in[end]) == std::string_view::npos)) continue;
    name.erase(end < in.size() || at == 0 ? at : at - 1, wanted.size() + 1);
    return true;
  }
  return false;
}

struct NamedChannel {
  ChannelPlace place;
  std::string prefix;       // the layer as the file has it
  std::string part, layer;  // without the view
  std::string own;          // "R"
  std::string view;         // empty: none
};

std::string layer_of(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

// What follows the last dot, in small letters.
std::string last_word(const std::string& name) {
  return in_lower_case(name.substr(name.rfind('.') + 1));
}

std::vector<NamedChannel> named_channels(const ImageHeader& header) {
  const std::vector<std::string> views = views_of(header);
  std::vector<NamedChannel> all;
  for (std::size_t p = 0; p < header.parts.size(); ++p) {
    const ImagePart& part = header.parts[p];
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
      const std::string layer = layer_of(part.channels[c].name);
      NamedChannel one = {.place = {static_cast<int>(p), static_cast<int>(c)},
                          .prefix = layer,
                          .part = part.name,
                          .layer = layer,
                          .own = part.channels[c].name.substr(layer.empty() ? 0 : layer.size() + 1),
                          .view = part.view};
      const auto is_of = [&](const std::string& view) {
        const bool by_layer = take_out(view, one.layer), by_part = take_out(view, one.part);
        return by_layer || by_part;
      };
      const auto found = part.view.empty() ? std::find_if(views.begin(), views.end(), is_of) : views.end();
      if (!part.view.empty()) is_of(part.view);
      if (found != views.end()) one.view = *found;
      // In one part for all views, what has no layer is the default view's.
      if (one.view.empty() && !header.views.empty() && header.parts.size() == 1 && layer.empty())
        one.view = views.front();
      all.push_back(std::move(one));
    }
  }
  return all;
}

// The channel's name among those of all parts.
std::string full_name(const ImageHeader& header, ChannelPlace place) {
  return dotted({header.parts.size() > 1 ? header.parts[place.part].name : "", header.at(place).name});
}

struct Candidate {
  Picture picture;
  std::string label;        // as an option takes it
  std::string part, layer;  // without the view
  std::string prefix;       // as NamedChannel has it
  std::string name;         // last_word() of the layer, or else of the part
  bool grey = false, deep = false;

  bool is_crypto() const { return name.starts_with("crypto"); }
  bool is_beauty() const {
    constexpr std::string_view kNames[] = {"rgba", "rgb", "beauty", "combined", "color", "colour",
                                           "c",    "ci",  "main",   "master",   "final", "finalimage"};
    return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
  }
  bool is_usual() const { return layer.empty() || is_beauty(); }
};

using Candidates = std::vector<Candidate>;

// Fills in the channels of a layer, which are [first, last). Returns whether they are a picture.
bool take_picture(const ImageHeader& header, const NamedChannel* first, const NamedChannel* last,
                  Candidate& candidate) {
  const auto named = [&](std::initializer_list<const char*> spellings) {
    for (const char* own : spellings) {
      const auto found = std::find_if(first, last, [&](const NamedChannel& one) { return one.own == own; });
      if (found != last) return full_name(header, found->place);
    }
    return std::string();
  };
  std::string r = named({"R", "r", "Red", "red"}), g = named({"G", "g", "Green", "green"}),
              b = named({"B", "b", "Blue", "blue"}), a = named({"A", "a", "Alpha", "alpha"});
  if (r.empty() || g.empty() || b.empty()) {
    // Y is not grey where it is the luminance of a colour or a direction's second part.
    candidate.grey = r.empty() && g.empty() && b.empty() && named({"RY", "BY", "X"}).empty();
    r = g = b = candidate.grey ? named({"Y"}) : "";
  }
  if (a.empty()) a = dotted({candidate.label, "A"});
  candidate.picture.channels = {r, g, b, a};
  return !r.empty();
}

Candidates pictures_in(const ImageHeader& header) {
  const std::vector<NamedChannel> all = named_channels(header);
  Candidates candidates;
  for (const NamedChannel *first = all.data(), *end = first + all.size(), *last; first != end; first = last) {
    last = std::find_if(first, end, [&](const NamedChannel& one) {
      return one.place.part != first->place.part || one.prefix != first->prefix;
    });
    const ImagePart& part = header.parts[first->place.part];
    Candidate candidate = {.picture = {.channels = {}, .part = first->place.part, .view = first->view},
                           .label = dotted({header.parts.size() > 1 ? part.name : "", first->prefix}),
                           .part = first->part,
                           .layer = first->layer,
                           .prefix = first->prefix,
                           .name = last_word(first->layer.empty() ? first->part : first->layer),
                           .deep = part.deep};
    if (take_picture(header, first, last, candidate)) candidates.push_back(std::move(candidate));
  }
  return candidates;
}

template <typename Are>
void keep(Candidates& candidates, Are are) {
  std::erase_if(candidates, [&](const Candidate& one) { return !are(one); });
}

// As keep(), unless that would leave none.
template <typename Are>
void prefer(Candidates& candidates, Are are) {
  if (std::any_of(candidates.begin(), candidates.end(), are)) keep(candidates, are);
}

// "; --colour takes a layer of it: beauty, albedo"; empty where there is none.
std::string labels_text(Candidates candidates, const std::string& option) {
  std::string text;
  prefer(candidates, [](const Candidate& one) { return !one.is_crypto(); });
  for (const Candidate& one : candidates)
    if (!one.label.empty())
      text +=
          text.empty() ? fmt::format("; {} takes a layer of it: {}", option, one.label) : ", " + one.label;
  return text;
}

// -1: there is none.
int part_named(const ImageHeader& header, const std::string& name) {
  const auto found = std::find_if(header.parts.begin(), header.parts.end(),
                                  [&](const ImagePart& part) { return part.name == name; });
  if (found != header.parts.end()) return static_cast<int>(found - header.parts.begin());
  int index = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  const bool counts = error == std::errc() && end == name.data() + name.size() && index >= 0;
  return counts && index < static_cast<int>(header.parts.size()) ? index : -1;
}

// Leaves one where no other could be meant, and none where that is no picture's usual place.
void choose_by_name(Candidates& left, const PictureWish& wish) {
  if (!wish.layer.empty()) {
    prefer(left, [&](const Candidate& one) { return one.label == wish.layer; });
    return;
  }
  const Candidates all = left;
  keep(left, [&](const Candidate& one) {
    return one.layer.empty() || std::none_of(all.begin(), all.end(), [&](const Candidate& other) {
             return other.layer.empty() && other.picture.part == one.picture.part &&
                    other.picture.view == one.picture.view;
           });
  });
  prefer(left, [](const Candidate& one) { return !one.is_crypto(); });
  prefer(left, [](const Candidate& one) { return one.is_usual() && !one.grey; });
  if (wish.part.empty() || left.size() > 1) keep(left, [](const Candidate& one) { return one.is_usual(); });
  prefer(left, [](const Candidate& one) { return one.is_beauty(); });
}

// As channels_beside() has them, in one part.
struct Found {
  int part = 0;
  int distance = 0;        // 0: of the view, or called so by the caller; 1: of no view
  bool is_vector = false;  // of which Z is a part
  bool is_depth = false;   // by the part's name
  std::vector<std::string> names = {};
};

// How far a channel of this name is from the view; nothing where it is another, or of another view.
std::optional<int> distance_to(const ImageHeader& header, const NamedChannel& channel,
                               const std::string& name, const std::string& view) {
  const bool without_view = name == dotted({channel.layer, channel.own}) ||
                            name == dotted({channel.part, channel.layer, channel.own});
  if (!without_view && !header.is_called(channel.place, name)) return std::nullopt;
  if (channel.view.empty()) return 1;
  return channel.view == view || !without_view ? std::optional(0) : std::nullopt;
}

std::optional<Found> found_in(int part, const ImageHeader& header, const std::vector<NamedChannel>& channels,
                              const std::vector<std::string>& names, const std::string& view) {
  Found found = {.part = part};
  for (const std::string& name : names) {
    const NamedChannel* nearest = nullptr;
    int least = 2;
    for (const NamedChannel& channel : channels) {
      if (channel.place.part != part) continue;
      const int distance = distance_to(header, channel, name, view).value_or(2);
      if (distance < least) nearest = &channel, least = distance;
    }
    if (nearest == nullptr) return std::nullopt;
    found.names.push_back(full_name(header, nearest->place));
    found.distance = std::max(found.distance, least);
    const auto has = [&](const char* own) {
      return std::any_of(channels.begin(), channels.end(), [&](const NamedChannel& one) {
        return one.place.part == part && one.prefix == nearest->prefix && one.own == own;
      });
    };
    found.is_vector |= names.size() == 1 && nearest->own == "Z" && has("X") && has("Y");
    found.is_depth |= last_word(nearest->part) == "depth" || last_word(nearest->part) == "z";
  }
  return found;
}

std::string in_several(const std::string& name, const std::vector<std::string>& full_names) {
  return fmt::format("has channel '{}' in several parts; name one: '{}'", name,
                     fmt::join(full_names, "' or '"));
}

// Whether a picture would be larger than any film's, and nearly all of it empty.
bool is_hardly_filled(const ImagePart& part) {
  constexpr std::int64_t kMostPixels = 8192 * 4320, kLeastPart = 16;
  const Extent shown = part.shown().extent;
  const bool shows = shown.width > 0 && shown.height > 0;
  const std::int64_t pixels = part.display.extent.area();
  return pixels > kMostPixels && pixels / kLeastPart > (shows ? shown.area() : 0);
}

// Looks channels up one after another and keeps the first thing that is wrong.
class Search {
 public:
  Search(const std::string& path, const ImageHeader& header, const std::string& option)
      : path_(path), header_(header), option_(option) {}

  std::optional<ChannelPlace> find(const std::string& name, bool is_colour = false) {
    if (!status_.ok()) return std::nullopt;
    const std::vector<ChannelPlace> places = header_.places_of(name);
    if (places.empty()) {
      complain(fmt::format("has no channel '{}'; it has {}{}", name, header_.channel_names(),
                           is_colour ? labels_text(pictures_in(header_), option_) : ""));
    } else if (places.size() > 1) {
      complain(in_several(name, {full_name(header_, places[0]), full_name(header_, places[1])}));
    } else {
      check(name, places[0]);
    }
    return status_.ok() ? std::optional(places[0]) : std::nullopt;
  }

  // The next of a picture's channels.
  std::optional<ChannelPlace> find_beside(const std::optional<ChannelPlace>& first, const std::string& name) {
    const auto place = find(name, true);
    if (place && first && place->part != first->part)
      complain(fmt::format("has channel '{}' in another part than '{}', and a picture is of one part{}", name,
                           full_name(header_, *first), labels_text(pictures_in(header_), option_)));
    return place;
  }

  const std::optional<ImageWindow>& display() const { return display_; }
  bool dwa() const { return dwa_; }
  const Status& status() const { return status_; }

 private:
  void check(const std::string& name, ChannelPlace place) {
    const ImagePart& part = header_.parts[place.part];
    const auto [width, height] = part.display.extent;
    dwa_ |= part.dwa;
    if (part.deep) {
      complain(fmt::format("holds deep pixels in channel '{}'; flat ones are needed", name));
    } else if (header_.at(place).integer) {
      complain(fmt::format("holds integers in channel '{}'; half or float is needed", name));
    } else if (const auto [x, y] = header_.at(place).sampling; x != 1 || y != 1) {
      complain(fmt::format("has channel '{}' subsampled {}x{}; render it at full size", name, x, y));
    } else if (display_ && part.display.extent != display_->extent) {
      complain(fmt::format("has channel '{}' at {}x{} pixels, but its colour at {}x{}", name, width, height,
                           display_->extent.width, display_->extent.height));
    } else if (is_hardly_filled(part)) {
      complain(
          fmt::format("has a display window of {}x{} pixels, and {}x{} of them with data; a display window "
                      "is the picture's size",
                      width, height, part.data.extent.width, part.data.extent.height));
    } else if (!display_) {
      display_ = part.display;
    }
  }

  void complain(const std::string& what) { status_ = Status::io(fmt::format("'{}' {}", path_, what)); }

  const std::string& path_;
  const ImageHeader& header_;
  const std::string& option_;
  std::optional<ImageWindow> display_;
  bool dwa_ = false;
  Status status_;
};

}  // namespace

std::vector<std::string> views_of(const ImageHeader& header) {
  std::vector<std::string> views = header.views;
  const auto add = [&views](const std::string& view) {
    if (std::find(views.begin(), views.end(), view) == views.end()) views.push_back(view);
  };
  for (const ImagePart& part : header.parts)
    if (!part.view.empty()) add(part.view);
  if (const Attribute* first = header.attribute("defaultView")) {
    std::stable_partition(views.begin(), views.end(),
                          [&](const std::string& view) { return first->value == AttributeValue(view); });
  }
  if (!views.empty()) return views;
  bool all_have_one = true;
  for (const ImagePart& part : header.parts) {
    for (const HeaderChannel& channel : part.channels) {
      bool has_one = false;
      for (const char* view : {"left", "right"}) {
        std::string name = dotted({part.name, layer_of(channel.name)});
        if (!take_out(view, name)) continue;
        add(view);
        has_one = true;
      }
      all_have_one &= has_one;
    }
  }
  if (views.size() < 2 && !all_have_one) views.clear();
  return views;
}

Result<Picture> choose_picture(const std::string& path, const ImageHeader& header, const PictureWish& wish) {
  const std::vector<std::string> views = views_of(header);
  Candidates left = pictures_in(header);
  Picture none;
  if (!wish.part.empty()) {
    none.part = part_named(header, wish.part);
    if (none.part < 0) {
      std::vector<std::string> names;
      for (const ImagePart& part : header.parts)
        names.push_back(part.name);
      return Status::invalid(fmt::format("--part: '{}' has no part '{}'; it has {}: {}", path, wish.part,
                                         names.size(), fmt::join(names, ", ")));
    }
    keep(left, [&](const Candidate& one) { return one.picture.part == none.part; });
  }
  if (!wish.view.empty()) {
    keep(left, [&](const Candidate& one) { return one.picture.view == wish.view; });
    if (left.empty())
      return Status::invalid(
          fmt::format("--view-name: '{}' has no picture of a view '{}'; its views are {}", path, wish.view,
                      views.empty() ? "not named" : fmt::format("{}", fmt::join(views, ", "))));
  }
  if (!wish.layer.empty()) {
    keep(left, [&](const Candidate& one) {
      const std::string& name = wish.layer;
      const std::string part = header.parts[one.picture.part].name;
      return name == one.prefix || name == one.layer || name == dotted({part, one.prefix}) ||
             name == dotted({one.part, one.layer});
    });
  }
  prefer(left, [&](const Candidate& one) {
    return one.picture.view.empty() || one.picture.view == (wish.view.empty() ? views.front() : wish.view);
  });
  choose_by_name(left, wish);
  prefer(left, [](const Candidate& one) { return !one.deep; });
  if (left.size() == 1) return left.front().picture;
  if (left.size() > 1)
    return Status::invalid(
        fmt::format("'{}' holds several pictures{}", path, labels_text(left, wish.option)));
  const std::string part = wish.part.empty() ? "" : header.parts[none.part].name;
  for (std::string& channel : none.channels)
    channel = dotted({part, wish.layer, channel});
  return none;
}

Result<std::vector<std::string>> channels_beside(const std::string& path, const ImageHeader& header,
                                                 const Picture& picture,
                                                 const std::vector<std::string>& names, bool asked) {
  const std::vector<NamedChannel> channels = named_channels(header);
  const std::vector<std::string> views = views_of(header);
  const std::string view = picture.view.empty() && !views.empty() ? views.front() : picture.view;
  std::vector<Found> all;
  for (int part = 0; part < static_cast<int>(header.parts.size()); ++part)
    if (auto found = found_in(part, header, channels, names, view)) all.push_back(*std::move(found));
  // Whose motion is of no view it is the default one's, if anyone's.
  if (!asked && !views.empty() && view != views.front())
    std::erase_if(all, [](const Found& one) { return one.distance > 0; });
  const auto prefer_found = [&all](auto is) {
    if (std::any_of(all.begin(), all.end(), is))
      std::erase_if(all, [&](const Found& one) { return !is(one); });
  };
  prefer_found([](const Found& one) { return !one.is_vector; });
  prefer_found([&](const Found& one) { return one.part == picture.part; });
  prefer_found([](const Found& one) { return one.distance == 0; });
  prefer_found([](const Found& one) { return one.is_depth; });
  if (all.size() > 1)
    return Status::invalid(
        fmt::format("'{}' {}", path, in_several(names[0], {all[0].names[0], all[1].names[0]})));
  if (!all.empty()) return all.front().names;
  std::vector<std::string> apart;
  for (std::size_t i = 0; names.size() > 1 && i < names.size(); ++i) {
    auto one = channels_beside(path, header, picture, {names[i]}, asked);
    if (!one.ok() || one->empty()) return one;
    apart.push_back(one->front());
  }
  return apart;
}

std::string first_of_view(const ImageHeader& header, const std::string& view) {
  const std::vector<NamedChannel> all = named_channels(header);
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const NamedChannel& one) { return !view.empty() && one.view == view; });
  return full_name(header, found != all.end() ? found->place : ChannelPlace{});
}

std::vector<std::string> albedo_beside(const ImageHeader& header, const Picture& picture) {
  Candidates candidates = pictures_in(header);
  keep(candidates, [&](const Candidate& one) {
    return (one.name == "albedo" || one.name == "denoising albedo") && !one.grey &&
           (one.picture.view.empty() || one.picture.view == picture.view);
  });
  prefer(candidates, [&](const Candidate& one) { return one.picture.part == picture.part; });
  if (candidates.empty()) return {};
  const auto& channels = candidates.front().picture.channels;
  return {channels.begin(), channels.begin() + 3};
}

std::string colour_text(const ChannelNames& names) {
  const auto& colour = names[InputPlane::kColour];
  if (colour[0] == colour[1]) return fmt::format("grey {},{}", colour[0], colour[3]);
  return fmt::format("colour {}", fmt::join(colour, ","));
}

bool leaves_pixels_open(const ImagePart& part) {
  const ImageWindow& data = part.data;
  const ImageWindow& display = part.display;
  return data.x > display.x || data.y > display.y ||
         data.x + data.extent.width < display.x + display.extent.width ||
         data.y + data.extent.height < display.y + display.extent.height;
}

Result<ChannelPlaces> find_channels(const std::string& path, const ImageHeader& header,
                                    const ChannelNames& names, const std::string& option) {
  Search search(path, header, option);
  ChannelPlaces places;
  auto& colour = places[InputPlane::kColour];
  for (const std::string& name : names[InputPlane::kColour]) {
    if (colour.size() < 3) {
      colour.push_back(search.find_beside(colour.empty() ? std::nullopt : colour[0], name));
      continue;
    }
    colour.emplace_back();
    for (const ChannelPlace place : header.places_of(name))
      if (colour[0] && place.part == colour[0]->part) colour[3] = search.find(full_name(header, place));
  }
  for (std::size_t p = 0; p < kPlaneCount; ++p) {
    const auto plane = static_cast<InputPlane>(p);
    if (plane == InputPlane::kColour) continue;
    for (const std::string& name : names[plane])
      places[plane].push_back(search.find(name));
  }
  if (!search.status().ok()) return search.status();
  places.display = *search.display();
  places.dwa = search.dwa();
  places.background = !colour.back();
  for (const auto& place : colour) {
    places.background &= !place || !leaves_pixels_open(header.parts[place->part]);
    places.half_colour &= !place || header.at(*place).stored == ChannelType::kHalf;
  }
  return places;
}

}  // namespace quincunx::tools
