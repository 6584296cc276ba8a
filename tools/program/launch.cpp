// SPDX-License-Identifier: BSD-3-Clause
// Chooses the number of processes and threads of a run, and starts it under mpiexec.
#include "program/launch.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "program/command.hpp"
#include "program/control_group.hpp"
#include "program/interrupt.hpp"
#include "program/mpi_folder.hpp"
#include "program/signal_pipe.hpp"
#include "program/terminal.hpp"

namespace kacanov {
namespace {

/// Marks a process that run_under_mpiexec() started.
constexpr const char* started_mark = "KACANOV_STARTED_BY_ITSELF";
/// Added to non-zero exit codes that pass through mpiexec.
constexpr int code_offset = 80;

/// Forwards signals to mpiexec while it runs, in a thread of its own.
class PassedSignals {
 public:
  static std::shared_ptr<PassedSignals> to(pid_t mpiexec) {
    auto passed = std::make_shared<PassedSignals>();
    passed->mpiexec_ = mpiexec;
    std::thread([passed] { passed->watch(); }).detach();
    return passed;
  }

  /// Called when mpiexec has ended. Returns the last signal that requested an end; 0: none.
  int finish() {
    const std::lock_guard<std::mutex> lock(mutex_);
    mpiexec_ = 0;
    return last_;
  }

 private:
  void watch() {
    constexpr int a_while = 200;  // milliseconds between checks of the clock
    for (bool asked = false;;) {
      const int signal = next_signal(asked ? a_while : -1);
      const std::lock_guard<std::mutex> lock(mutex_);
      if (signal != 0) take(signal);
      asked = last_ != 0 && mpiexec_ != 0;
      if (asked) repeat();
    }
  }

  void take(int signal) {
    if (signal == SIGTSTP || signal == SIGCONT) {
      // mpiexec is not in the terminal's foreground process group: stop its ranks first, then this process.
      if (mpiexec_ != 0) kill(mpiexec_, signal);
      if (signal == SIGTSTP) raise(SIGSTOP);
      return;
    }
    if (mpiexec_ == 0) end_by(signal);
    last_ = signal;
    if (asks_again(first_) && insisting_ == 0) insisting_ = 1;
    send();
  }

  /// Repeats the signal every second, as mpiexec or the ranks may not listen yet. If mpiexec is still running
  /// a few seconds after a second request, it is killed together with the ranks.
  void repeat() {
    if (seconds_since(sent_) < 1.0) return;
    if (insisting_ > 0) ++insisting_;
    send();
  }

  void send() {
    constexpr int patience = 5;  // seconds
    kill(mpiexec_, insisting_ == 0 ? stop_signal : insisting_ <= patience ? SIGTERM : SIGKILL);
    clock_gettime(CLOCK_MONOTONIC, &sent_);
  }

  std::mutex mutex_;
  pid_t mpiexec_ = 0;  ///< 0 once it has ended
  int last_ = 0;
  int insisting_ = 0;  ///< seconds since the second request
  timespec first_{}, sent_{};
};

/// If Open MPI cannot map its libraries and shared memory, it crashes with a trace or hangs.
void refuse_narrow_limit() {
  constexpr rlim_t megabyte = 1 << 20, least = 512;  // mpiexec and one rank use 200 to 300
  const std::optional<std::uintmax_t> limit = address_space_limit();
  if (!limit || *limit >= least * megabyte) return;
  throw InputError("several ranks cannot be started: the address space of a process is limited to " +
                   std::to_string(*limit / megabyte) + " MiB (ulimit -v), and MPI needs " +
                   std::to_string(least));
}

/// Returns an anonymous file that contains `text`, positioned at its start.
int nameless_file(const std::string& text) {
  const int file = memfd_create("kacanov-case", MFD_CLOEXEC);
  std::size_t written = 0;
  while (file >= 0 && written < text.size()) {
    const ssize_t more = write(file, text.data() + written, text.size() - written);
    if (more < 0) break;
    written += static_cast<std::size_t>(more);
  }
  if (file < 0 || written < text.size() || lseek(file, 0, SEEK_SET) != 0)
    throw InternalError(std::string("cannot hand the case to the ranks: ") + std::strerror(errno));
  return file;
}

/// Copies available output to standard output; returns false at the end. Reads even if the copy fails,
/// because mpiexec ends a run whose output it cannot write.
bool pass_output_on(int from) {
  std::array<char, 4096> piece{};
  const ssize_t size = read(from, piece.data(), piece.size());
  if (size < 0) return errno == EINTR;
  for (ssize_t done = 0; done < size;) {
    const ssize_t more = write(STDOUT_FILENO, piece.data() + done, size - done);
    if (more < 0 && errno != EINTR) break;
    done += std::max<ssize_t>(more, 0);
  }
  return size > 0;
}

/// Forwards the output of a process until it has ended; returns its status.
int wait_and_pass_on(pid_t child, int output) {
  constexpr int patience = 100;  // milliseconds between checks of a silent process
  pollfd channel{output, POLLIN, 0};
  int status = 0;
  bool open = true, running = true;
  while (running) {
    running = waitpid(child, &status, open ? WNOHANG : 0) != child;
    // After the end, copy the remaining output, but do not wait for other holders of the pipe.
    while (open && poll(&channel, 1, running ? patience : 0) > 0) open = pass_output_on(output);
  }
  return status;
}

[[noreturn]] void become_mpiexec(const std::vector<std::string>& words, int input, int output) {
  // A process group of its own, so that a keyboard interrupt arrives once, through PassedSignals; the death
  // signal avoids an orphan if this program is killed.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  std::signal(stop_signal, SIG_IGN);  // until mpiexec handles it
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  _exit(127);
}

}  // namespace

bool started_by_mpi() {
  constexpr const char* marks[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK",
                                   "MPI_LOCALNRANKS"};
  for (const char* mark : marks) {
    if (std::getenv(mark) != nullptr) return true;
  }
  // Inside a batch script SLURM_STEP_ID is not set: only srun creates steps with several tasks.
  return std::getenv("SLURM_STEP_ID") != nullptr && std::getenv("SLURM_STEP_NUM_TASKS") != nullptr;
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  std::set<std::string> cores;  // hardware threads of one core have the same list of siblings
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &set)) continue;
    PlainFile file("/sys/devices/system/cpu/cpu" + std::to_string(cpu) + "/topology/thread_siblings_list");
    std::string siblings;
    if (!(file >> siblings)) siblings = "cpu" + std::to_string(cpu);
    cores.insert(siblings);
  }
  const double quota = std::max(1.0, control_group_limits().cores);
  return static_cast<int>(std::clamp(static_cast<double>(cores.size()), 1.0, quota));
}

std::int64_t estimate_unknowns(const MeshSource& mesh) {
  if (mesh.box) {
    const int dim = dimension(mesh.box->type);
    const int order = cell(mesh.box->type).order;
    double nodes = 1.0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(dim); ++c)
      nodes *= 1.0 + order * static_cast<double>(mesh.box->cells[c]);
    return static_cast<std::int64_t>(std::min(nodes * dim, 9e18));
  }
  // A tetrahedral mesh has 5.5 elements per node: about 240 bytes of text for three unknowns.
  constexpr std::int64_t bytes_per_unknown = 80;
  std::error_code error;
  const auto bytes = mesh.content ? mesh.content->size() : std::filesystem::file_size(*mesh.file, error);
  if (error) return 0;
  // Each refinement has eight times as many unknowns; quadratic tetrahedra have about seven times those of
  // linear ones.
  const double more = std::ldexp(mesh.order == 2 ? 7.0 : 1.0, 3 * mesh.refine);
  return static_cast<std::int64_t>(std::min(more * static_cast<double>(bytes) / bytes_per_unknown, 9e18));
}

Shape choose_shape(const Case& input, std::optional<int> ranks, std::optional<int> threads, int cores) {
  Shape shape;
  shape.threads = threads.value_or(1);
  const bool small = estimate_unknowns(input.mesh) < small_problem;
  shape.ranks = ranks.value_or(small ? 1 : std::max(1, cores / shape.threads));
  return shape;
}

std::optional<std::uintmax_t> address_space_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

std::string find_mpiexec() {
  const char* path = std::getenv("PATH");
  PlainWords folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  std::string folder;
  while (std::getline(folders, folder, ':')) {
    const std::string file = (folder.empty() ? "." : folder) + "/mpiexec";
    if (access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

void set_mpi_environment() {
  constexpr const char* settings[][2] = {
      {"OMPI_ALLOW_RUN_AS_ROOT", "1"},
      {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
      // Containers forbid the system call for single copies; plain shared memory suffices.
      {"OMPI_MCA_btl_vader_single_copy_mechanism", "none"},
      {"OMPI_MCA_btl", "self,vader"},
      // Without these, even a single process searches for ssh and starts a daemon.
      {"OMPI_MCA_plm", "isolated"},
      {"OMPI_MCA_ess_singleton_isolated", "1"},
      {"OMPI_MCA_pml", "ob1"},
      {"OMPI_MCA_btl_base_warn_component_unused", "0"},
      // Waiting ranks yield the processor: on a busy machine, spinning ranks slow down the run.
      {"OMPI_MCA_mpi_yield_when_idle", "1"},
      // mpiexec forwards SIGTSTP and SIGCONT to the ranks.
      {"OMPI_MCA_orte_forward_job_control", "1"},
      // If one rank exits with an error code, the others are killed at once instead of after a second.
      {"OMPI_MCA_odls_base_sigkill_timeout", "0"},
      {"HWLOC_HIDE_ERRORS", "2"},
      // Runs use no devices, and scanning all of them takes a third of the time of a small run.
      {"HWLOC_COMPONENTS", "-pci,-linuxio"},
  };
  for (const auto& [name, value] : settings) setenv(name, value, 0);
}

int coded_exit(int exit_code) {
  return exit_code != 0 && std::getenv(started_mark) != nullptr ? exit_code + code_offset : exit_code;
}

CaseText case_text_handed_down(const std::string& path) {
  if (std::getenv(started_mark) == nullptr) return read_case_text(path);
  std::string text;
  std::array<char, 1 << 16> piece{};
  for (ssize_t size = 1; size != 0;) {
    size = read(STDIN_FILENO, piece.data(), piece.size());
    if (size < 0 && errno != EINTR)
      throw InternalError(std::string("the case that mpiexec hands down cannot be read: ") +
                          std::strerror(errno));
    text.append(piece.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  }
  return {path, text};
}

std::string own_executable(const char* link) {
  std::error_code error;
  const std::filesystem::path file = std::filesystem::read_symlink(link, error);
  if (!error) return file.string();
  const auto* started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  return std::filesystem::absolute(started != nullptr ? started : "kacanov").string();
}

int run_under_mpiexec(const std::string& mpiexec, Shape shape, const HandedDown& handed) {
  refuse_narrow_limit();
  std::vector<std::string> words{mpiexec, "--quiet", "--oversubscribe",           "--bind-to",
                                 "none",  "-n",      std::to_string(shape.ranks), own_executable()};
  for (const char* argument : handed.arguments.subspan(1)) words.emplace_back(argument);
  std::optional<MpiFolder> folder(std::in_place, handed.folder);
  set_mpi_environment();
  setenv(started_mark, "1", 1);
  hand_terminal_down();

  catch_signals({SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT});
  const int input = nameless_file(handed.case_text);
  int channel[2];
  if (pipe2(channel, O_CLOEXEC) != 0)
    throw InternalError(std::string("cannot start mpiexec: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) throw InternalError(std::string("cannot start mpiexec: ") + std::strerror(errno));
  if (child == 0) {
    folder->hand_down();  // the ranks may outlive this process by a few seconds
    become_mpiexec(words, input, channel[1]);
  }
  close(input);
  close(channel[1]);
  const std::shared_ptr<PassedSignals> signals = PassedSignals::to(child);
  const int status = wait_and_pass_on(child, channel[0]);
  const int signal = signals->finish();
  close(channel[0]);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (code == 0) return 0;
  if (code > code_offset && code <= code_offset + exit_failure) return code - code_offset;
  if (signal != 0) {  // it arrived before there was anything to stop properly
    folder.reset();
    end_by(signal);
  }
  std::string reason = "mpiexec failed with exit code " + std::to_string(code);
  if (code > 128)
    reason = "a process was ended by signal " + std::to_string(code - 128) +
             (code == 137 ? " (out of memory?)" : "");
  throw InternalError(reason);
}

}  // namespace kacanov
