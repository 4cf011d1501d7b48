// SPDX-License-Identifier: MIT
// The Slurm script of docs/sequences.md, as it stands there.
#include <algorithm>
#include <memory>

#include "farm/slurm_node.h"
#include "sequence/sequence_fixture.h"
#include "skip.h"

namespace quincunx {
namespace {

constexpr int kFirst = 1101, kLast = 1200;  // frames of task 1
constexpr Extent kPicture = {1280, 720};    // instead of the script's, which takes a minute

class Slurm : public testing::SequenceTest {
 protected:
  void SetUp() override {
    if (!testing::SlurmNode::is_installed())
      QUINCUNX_SKIP("Slurm is not installed (packages slurm-wlm and munge)");
    write_shot();
    write_script();
    node_ = std::make_unique<testing::SlurmNode>(folder_);
    ASSERT_TRUE(node_->is_up()) << node_->log();
  }

  void write_shot() const {
    std::filesystem::create_directories(folder_.file("shot"));
    const auto name = [&](int number) { return folder_.file(fmt::format("shot/shot.{}.exr", number)); };
    testing::FrameFile file = frame(1);
    file.extent = {320, 180};
    write_frame(name(kFirst), file);
    for (int number = kFirst + 1; number <= kLast; ++number)
      std::filesystem::create_hard_link(name(kFirst), name(number));
  }

  void write_script() const {
    const std::string text = testing::read_file(std::string(QUINCUNX_DOCS) + "/sequences.md");
    const std::size_t begin = text.find("#!/bin/bash\n#SBATCH");
    ASSERT_NE(begin, std::string::npos);
    std::string script = text.substr(begin, text.find("```", begin) - begin);
    const std::size_t size = script.find("3840x2160");
    ASSERT_NE(size, std::string::npos) << script;
    script.replace(size, 9, fmt::format("{}x{}", kPicture.width, kPicture.height));
    std::ofstream(folder_.file("task.sh")) << script;
  }

  std::string made(int number) const { return folder_.file(fmt::format("up/up.{}.exr", number)); }

  int count_made() const {
    int count = 0;
    for (int number = kFirst; number <= kLast; ++number)
      count += std::filesystem::exists(made(number)) ? 1 : 0;
    return count;
  }

  bool has_state(const std::string& state) const {
    return node_->run("scontrol show job " + job_).out.find("JobState=" + state) != std::string::npos;
  }

  // Programs whose working folder is this test's: those of its tasks.
  int running() const {
    int count = 0;
    std::error_code error;
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
      const auto folder = std::filesystem::read_symlink(process.path() / "cwd", error);
      const bool ours = !error && folder == std::filesystem::path(folder_.file("")).parent_path();
      count += ours && testing::read_file(process.path() / "comm").starts_with("quincunx-resol") ? 1 : 0;
    }
    return count;
  }

  void submit() {
    const auto result = node_->run(
        "sbatch --parsable --array=1 --cpus-per-task=1 --chdir='{}/' --output='{}/task.out' '{}/task.sh'");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    job_ = result.out.substr(0, result.out.find('\n')) + "_1";
  }

  std::unique_ptr<testing::SlurmNode> node_;
  std::string job_;
};

// A signal to the batch step ends the program, not only a shell around it; what is left is made by another try.
TEST_F(Slurm, ASignalEndsATaskAndARequeueFinishesIt) {
  using std::chrono::seconds;
  submit();
  ASSERT_TRUE(testing::wait_until([&] { return count_made() >= 3; }, seconds(120))) << node_->log();
  EXPECT_EQ(running(), 1);
  node_->run("scancel --batch --signal=TERM " + job_);
  ASSERT_TRUE(testing::wait_until([&] { return has_state("FAILED"); }, seconds(60))) << node_->log();
  EXPECT_EQ(running(), 0);
  const int before = count_made();
  EXPECT_LT(before, kLast - kFirst + 1);
  const std::string said = testing::read_file(folder_.file("task.out"));
  EXPECT_NE(said.find("stopped by a signal; the files are whole, and --resume goes on"), std::string::npos)
      << said;
  EXPECT_EQ(image(made(kFirst)).extent, kPicture);
  const auto written = std::filesystem::last_write_time(made(kFirst));

  const auto requeued = node_->run("scontrol requeue " + job_);
  ASSERT_EQ(requeued.exit_code, 0) << requeued.err;
  // A farm waits a while. In the second in which a job has ended its node refuses to launch it ("already killed").
  node_->run("scontrol update JobId=" + job_ + " StartTime=now+3");
  ASSERT_TRUE(testing::wait_until([&] { return has_state("COMPLETED"); }, seconds(240))) << node_->log();
  EXPECT_EQ(count_made(), kLast - kFirst + 1);
  EXPECT_EQ(std::filesystem::last_write_time(made(kFirst)), written);
}

}  // namespace
}  // namespace quincunx
