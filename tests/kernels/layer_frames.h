// SPDX-License-Identifier: MIT
// Two frames in which near surfaces move apart from far ones, the records that the first leaves to the second,
// and the kernels that find both.
#pragma once

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "../reference/layers.h"
#include "kernel_fixture.h"
#include "layers/layer.h"
#include "pass_rig.h"

namespace quincunx::testing {

struct LayerVariant {
  Storage storage = Storage::kBuffer;
  PixelFormat velocity = PixelFormat::kRG16F;
};
std::vector<LayerVariant> layer_variants();
std::string name_of(const LayerVariant& variant);
inline std::string layer_variant_names(const ::testing::TestParamInfo<LayerVariant>& instance) {
  return sample_names(layer_variants(), [](const LayerVariant& v) { return name_of(v); })(instance);
}

enum class Surfaces {
  kWires,  // thin and thick things before a wall and a plane seen at a slant, each with a motion of its own
  kWall,   // the wall alone: as where every sample misses the things before it
  kNoise,  // each sample a surface of its own
  kNonFinite,  // the same with NaN, infinities and values at the end of the range
};

struct LayerSpec {
  Extent output;
  Extent render;
  Extent previous;
  Surfaces surfaces = Surfaces::kWires;
  unsigned seed = 1;
  bool first = false;  // nothing is known of a previous frame
  double outside = 0;
  bool tight = false;
};
std::string name_of(const LayerSpec& spec);

// Returns specs with every kind of surfaces in many sizes: first frames, and those that follow a viewport of another
// size.
std::vector<LayerSpec> all_layer_specs();

// A buffer with elements behind its end that no kernel may touch.
template <typename Element>
class GuardedBuffer {
 public:
  explicit GuardedBuffer(std::vector<Element> elements) : count_(elements.size()) {
    elements.resize(count_ + kGuard, guard());
    buffer_ = cl::Buffer(impl().context, CL_MEM_READ_WRITE, elements.size() * sizeof(Element));
    impl().queue.enqueueWriteBuffer(buffer_, CL_TRUE, 0, elements.size() * sizeof(Element), elements.data());
  }

  ImageView view() const { return {.memory = buffer_()}; }
  std::vector<Element> elements() const {
    std::vector<Element> all(count_ + kGuard);
    impl().queue.enqueueReadBuffer(buffer_, CL_TRUE, 0, all.size() * sizeof(Element), all.data());
    const Element kept = guard();
    for (std::size_t i = count_; i < all.size(); ++i)
      EXPECT_EQ(std::memcmp(&all[i], &kept, sizeof(Element)), 0) << "beyond the end of a buffer";
    all.resize(count_);
    return all;
  }

 private:
  static constexpr std::size_t kGuard = 64;
  static Element guard() {
    Element element;
    std::memset(&element, 0x5a, sizeof(element));
    return element;
  }

  std::size_t count_;
  cl::Buffer buffer_;
};

// A grid of records as the kernels hold it; `cells` and `records` of the references say the same.
struct KernelGrid {
  std::vector<cl_uint> keys;
  std::vector<LayerRecord> records;
};
cl_uint to_key(const reference::RecordCell& cell);
reference::RecordGrid to_reference(const KernelGrid& grid);

// The inputs of a kernel.
struct LayerFrames {
  FrameInputs current, previous;
  reference::LayerInputs reference;
  KernelGrid before;                // reference.before
  std::vector<Pixel> reprojection;  // one for each sample, its motion edge no less than it is
  std::vector<float> open_trust;    // one for each sample, as reproject has it
};

class RecordStages {
 public:
  explicit RecordStages(const LayerVariant& variant);

  LayerFrames frames(Rig& rig, const LayerSpec& spec);

  // layer_records: this frame's grid.
  KernelGrid find_records(Rig& rig, const LayerFrames& in, const LayerSpec& spec);
  // turn_records: `in` with the previous frame's records as they are then.
  LayerFrames turn_records(Rig& rig, LayerFrames in, const LayerSpec& spec, const KernelGrid& found);
  // advect_records: `found` with those that are carried over.
  KernelGrid advect_records(Rig& rig, const LayerFrames& in, const LayerSpec& spec, const KernelGrid& found);
  // One after the other; `in` becomes what turn_records makes of it.
  KernelGrid run_records(Rig& rig, LayerFrames& in, const LayerSpec& spec);

  struct Split {
    std::vector<LayerSplit> splits;
    std::vector<cl_int> marks;
    std::vector<LayerRecord> records;
    std::vector<Pixel> reprojection;
    std::vector<float> open_trust;
    std::vector<unsigned char> bytes;  // all of the above
  };
  Split run_split(Rig& rig, const LayerFrames& in, const LayerSpec& spec, const KernelGrid& now);

 private:
  TestFrame surfaces(Rig& rig, const LayerSpec& spec, bool is_previous) const;
  std::unique_ptr<PassRig> rig(const char* kernel) const;

  LayerVariant variant_;
  std::unique_ptr<PassRig> records_, turn_, advect_, split_;
};

}  // namespace quincunx::testing
