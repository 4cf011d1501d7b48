// SPDX-License-Identifier: MIT
#include "passes/two_way.h"

#include <cstddef>
#include <vector>

#include "device/opencl.h"
#include "passes/resolve_service_impl.h"
#include "picture_params.h"
#include "plan/inputs.h"

namespace quincunx {
namespace {

void write_bytes(const cl::CommandQueue& queue, const ImageView& to, const std::vector<std::byte>& bytes) {
  if (to) queue.enqueueWriteBuffer(borrow<cl::Buffer>(to.memory), CL_TRUE, 0, bytes.size(), bytes.data());
}

void read_bytes(const cl::CommandQueue& queue, const ImageView& from, std::size_t count,
                std::vector<std::byte>& bytes) {
  if (!from) return;
  bytes.resize(count);
  queue.enqueueReadBuffer(borrow<cl::Buffer>(from.memory), CL_TRUE, 0, count, bytes.data());
}

}  // namespace

Status ResolveService::Impl::write(const KeptHistory& kept, Resource texels, Resource alpha) {
  try {
    write_bytes(device.impl()->queue, picture.chain().newest(texels), kept.texels);
    write_bytes(device.impl()->queue, picture.chain().newest(alpha), kept.alpha);
    return {};
  } catch (...) {
    return caught("writing a history", device.info().name);
  }
}

Status ResolveService::Impl::read_merged(KeptHistory& kept) {
  const ResolveSettings& settings = picture.plan().settings;
  const auto pixels = static_cast<std::size_t>(settings.output_extent.area());
  const PassChain& chain = picture.chain();
  try {
    read_bytes(device.impl()->queue, chain.newest(Resource::kMergedHistory),
               pixels * bytes_per_pixel(settings.temporal.history), kept.texels);
    read_bytes(device.impl()->queue, chain.newest(Resource::kMergedAlpha), pixels * alpha_bytes(settings),
               kept.alpha);
    device.impl()->queue.enqueueReadBuffer(borrow<cl::Buffer>(chain.newest(Resource::kExposure).memory),
                                           CL_TRUE, offsetof(Exposure, factor), sizeof(float),
                                           &kept.exposure);
    return {};
  } catch (...) {
    return caught("reading a history", device.info().name);
  }
}

FrameReport ResolveService::Impl::show(const FrameInputs& inputs, float exposure, const FrameOutputs& outputs,
                                       const ImageView& albedo) {
  FrameReport refused;
  try {
    const cl::CommandQueue& queue = device.impl()->queue;
    FrameRing::Slot& slot = ring.begin();
    slot.report.frame_index = inputs.frame_index;
    slot.report.render_extent = inputs.render_extent;
    slot.report.output_extent = picture.plan().settings.output_extent;
    const Counter counted = {counter(), ring.index_of(slot)};
    const std::size_t at = static_cast<std::size_t>(counted.index) * sizeof(cl_uint);
    queue.enqueueFillBuffer(counter, cl_uint{0}, at, sizeof(cl_uint));
    const FrameInputs native = native_inputs(picture.plan().settings, inputs);
    const FrameOutputs made = native_outputs(picture.plan().settings, outputs);
    PassFrame frame = picture.chain().frame(native, nullptr, made, counted);
    frame.albedo = albedo;
    const Exposure shown = {exposure, 1 / exposure, 1, exposure};
    queue.enqueueWriteBuffer(borrow<cl::Buffer>(frame[Resource::kExposure].memory), CL_TRUE, 0, sizeof(shown),
                             &shown);
    frame[Resource::kVelocity] = shown_velocity.view();
    frame[Resource::kDepth] = shown_depth.view();
    picture.chain().show(frame, made, slot.report, slot.passes.data());
    queue.enqueueReadBuffer(counter, CL_FALSE, at, sizeof(slot.non_finite), &slot.non_finite, nullptr,
                            &slot.done);
    queue.flush();
    ring.commit();
    return slot.report;
  } catch (...) {
    refused.status = caught("showing a history", device.info().name);
    return refused;
  }
}

Result<ResolveService> TwoWay::create(const Device& device, const ResolvePlan& plan) {
  return ResolveService::create(device, plan, true);
}

ResolvePlan TwoWay::planned(const ResolvePlan& plan) {
  PlanFacts facts(plan.needs, plan.settings);
  facts.two_way = true;
  return plan_of(facts);
}

FrameReport TwoWay::add(ResolveService& service, const FrameInputs& inputs, bool merges, KeptHistory* kept) {
  ResolveService::Impl& impl = *service.impl_;
  FrameReport report;
  if (merges) report.status = impl.write(*kept, Resource::kOtherHistory, Resource::kOtherAlpha);
  if (!report.ok()) return report;
  impl.other_exposure = merges ? kept->exposure : 0;
  impl.keeps = kept != nullptr;
  report = impl.dispatch(inputs, nullptr, {}, {});
  if (!report.ok() || kept == nullptr) return report;
  report.status = impl.read_merged(*kept);
  if (!report.ok() || !service.plan().blurs()) return report;
  const auto texels = static_cast<std::size_t>(inputs.render_extent.area());
  const ImageView made = impl.picture.chain().newest(Resource::kVelocity);
  kept->velocity.resize(texels * bytes_per_pixel(service.plan().settings.velocity));
  kept->depth.resize(texels * sizeof(float));
  report.status =
      impl.device.download(made ? made : inputs.velocity, inputs.render_extent, kept->velocity.data());
  if (report.ok())
    report.status = impl.device.download(inputs.depth, inputs.render_extent, kept->depth.data());
  return report;
}

Status TwoWay::turn(ResolveService& backward, const ResolveService& forward) {
  const PassChain& from = forward.impl_->picture.chain();
  const PassChain& to = backward.impl_->picture.chain();
  try {
    for (const Resource kept :
         {Resource::kExposure, Resource::kHistory, Resource::kHistoryAlpha, Resource::kTileReprojection,
          Resource::kLayerTiles, Resource::kNearHistory, Resource::kLayerStates}) {
      const ImageView source = from.newest(kept);
      if (!source) continue;
      const auto memory = borrow<cl::Buffer>(source.memory);
      backward.impl_->device.impl()->queue.enqueueCopyBuffer(
          memory, borrow<cl::Buffer>(to.newest(kept).memory), 0, 0, memory.getInfo<CL_MEM_SIZE>());
    }
    return {};
  } catch (...) {
    return caught("turning round", backward.device().info().name);
  }
}

FrameReport TwoWay::show(ResolveService& service, const FrameInputs& inputs, const KeptHistory& kept,
                         const FrameOutputs& outputs, const ImageView& albedo) {
  ResolveService::Impl& impl = *service.impl_;
  FrameReport report;
  report.status = impl.write(kept, Resource::kMergedHistory, Resource::kMergedAlpha);
  if (report.ok() && !kept.velocity.empty()) {
    report.status =
        impl.device.upload(impl.shown_velocity.view(), inputs.render_extent, kept.velocity.data());
    if (report.ok())
      report.status = impl.device.upload(impl.shown_depth.view(), inputs.render_extent, kept.depth.data());
  }
  return report.ok() ? impl.show(inputs, kept.exposure, outputs, albedo) : report;
}

}  // namespace quincunx
