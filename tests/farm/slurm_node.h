// SPDX-License-Identifier: MIT
// SlurmNode: a farm of one node in a folder: munged, slurmctld and slurmd of the user who runs the tests, on free
// ports.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "program_run.h"

namespace quincunx::testing {

inline bool wait_until(const std::function<bool()>& condition, std::chrono::seconds at_most) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return true;
}

// A program that runs beside the test until the object ends.
class Daemon {
 public:
  Daemon(const std::vector<std::string>& words, const std::string& log) {
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words)
      arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  ~Daemon() {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

 private:
  pid_t pid_ = -1;
};

class SlurmNode {
 public:
  static constexpr std::array<const char*, 3> kPrograms = {"/usr/sbin/munged", "/usr/sbin/slurmctld",
                                                           "/usr/sbin/slurmd"};

  static bool is_installed() {
    return std::all_of(kPrograms.begin(), kPrograms.end(),
                       [](const char* program) { return std::filesystem::exists(program); });
  }

  explicit SlurmNode(const TemporaryFolder& folder) : folder_(folder) {
    // munged wants a folder whose sockets all may reach, and a key that nobody else may read.
    std::filesystem::create_directories(folder.file("slurm/state"));
    std::filesystem::create_directories(folder.file("slurm/spool"));
    using std::filesystem::perms;
    std::filesystem::permissions(folder.file("slurm"),
                                 perms::owner_all | perms::group_exec | perms::others_exec);
    std::ofstream(folder.file("slurm/key"), std::ios::binary) << key();
    std::filesystem::permissions(folder.file("slurm/key"), perms::owner_read);
    std::ofstream(folder.file("slurm/slurm.conf")) << configuration();
    if (newer_than_22()) std::ofstream(folder.file("slurm/cgroup.conf")) << "CgroupPlugin=disabled\n";
    const auto file = [&](const char* name) { return folder.file(std::string("slurm/") + name); };
    munged_ = std::make_unique<Daemon>(
        std::vector<std::string>{kPrograms[0], "-F", "--force", "--key-file=" + file("key"),
                                 "--socket=" + file("munge"), "--pid-file=" + file("munge.pid"),
                                 "--log-file=" + file("munge.log"), "--seed-file=" + file("munge.seed")},
        file("log"));
    wait_until([&] { return std::filesystem::exists(file("munge")); }, std::chrono::seconds(20));
    controller_ = std::make_unique<Daemon>(
        std::vector<std::string>{kPrograms[1], "-D", "-f", file("slurm.conf")}, file("log"));
    node_ = std::make_unique<Daemon>(std::vector<std::string>{kPrograms[2], "-D", "-f", file("slurm.conf")},
                                     file("log"));
  }

  ~SlurmNode() {
    run("scancel --user=$(id -un) --signal=KILL --full");
    run("scancel --user=$(id -un)");
    wait_until([&] { return run("squeue -h").out.empty(); }, std::chrono::seconds(20));
  }

  // Whether it takes jobs.
  bool is_up() {
    return wait_until([&] { return run("sinfo -h -o %t").out == "idle\n"; }, std::chrono::seconds(60));
  }

  // A command of Slurm's; its jobs find the program under its name.
  ProgramResult run(const std::string& command) const {
    const std::string path = std::filesystem::path(QUINCUNX_PROGRAM).parent_path().string();
    return run_program(
        folder_, command,
        fmt::format("SLURM_CONF='{}' PATH=\"{}:$PATH\"", folder_.file("slurm/slurm.conf"), path).c_str());
  }

  std::string log() const { return read_file(folder_.file("slurm/log")); }

 private:
  // Those want control groups, of which not every machine has any for us, or to be told that there are none.
  bool newer_than_22() const {
    const std::string version = run_program(folder_, "-V", kPrograms[2]).out;  // "slurm-wlm 22.05.8"
    const std::size_t space = version.find(' ');
    return space != std::string::npos && std::atoi(version.c_str() + space) > 22;
  }

  static std::string key() {
    std::random_device random;
    std::string key;
    for (int i = 0; i < 256; ++i)
      key += static_cast<char>(random());
    return key;
  }

  static int free_port() {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    socklen_t size = sizeof address;
    ::bind(socket, reinterpret_cast<sockaddr*>(&address), size);
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    ::close(socket);
    return ntohs(address.sin_port);
  }

  std::string configuration() const {
    std::array<char, 256> host = {};
    ::gethostname(host.data(), host.size() - 1);
    const std::string name = std::string(host.data()).substr(0, std::string(host.data()).find('.'));
    const std::string user = run_program(folder_, "-un", "id").out;
    const std::string folder = folder_.file("slurm");
    return fmt::format(
        "ClusterName=test\nSlurmctldHost={0}(127.0.0.1)\nSlurmUser={1}SlurmdUser={1}"
        "AuthType=auth/munge\nAuthInfo=socket={2}/munge\nSlurmctldPort={3}\nSlurmdPort={4}\n"
        "SlurmctldPidFile={2}/slurmctld.pid\nSlurmdPidFile={2}/slurmd.pid\n"
        "StateSaveLocation={2}/state\nSlurmdSpoolDir={2}/spool\n"
        "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nMpiDefault=none\nMailProg=/bin/true\n"
        "ReturnToService=2\nNodeName={0} "
        "NodeAddr=127.0.0.1 CPUs=1 State=UNKNOWN\n"
        "PartitionName=all Nodes={0} Default=YES State=UP\n",
        name, user, folder, free_port(), free_port());
  }

  const TemporaryFolder& folder_;
  std::unique_ptr<Daemon> munged_, controller_, node_;  // which end in the other order
};

}  // namespace quincunx::testing
