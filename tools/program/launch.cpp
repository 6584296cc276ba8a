// SPDX-License-Identifier: BSD-3-Clause
// How many processes and threads a run gets, and starting it under mpiexec.
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
#include "mesh/plain_stream.hpp"
#include "program/command.hpp"
#include "program/control_group.hpp"
#include "program/interrupt.hpp"
#include "program/mpi_folder.hpp"
#include "program/signal_pipe.hpp"
#include "program/terminal.hpp"

namespace kacanov {
namespace {

/// Marks a process that run_under_mpiexec started.
constexpr const char* started_mark = "KACANOV_STARTED_BY_ITSELF";
/// Added to exit codes other than 0 on the way through mpiexec.
constexpr int code_offset = 80;

/// Passes the signals that come while mpiexec runs on to it, in a thread of its own.
class PassedSignals {
 public:
  static std::shared_ptr<PassedSignals> to(pid_t mpiexec) {
    auto passed = std::make_shared<PassedSignals>();
    passed->mpiexec_ = mpiexec;
    std::thread([passed] { passed->watch(); }).detach();
    return passed;
  }

  /// mpiexec has ended. The last signal that asked for an end; 0: none.
  int finish() {
    const std::lock_guard<std::mutex> lock(mutex_);
    mpiexec_ = 0;
    return last_;
  }

 private:
  void watch() {
    constexpr int a_while = 200;  // milliseconds between two looks at the clock
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
      // mpiexec is not of the terminal's foreground group: its ranks stop first, then this process.
      if (mpiexec_ != 0) kill(mpiexec_, signal);
      if (signal == SIGTSTP) raise(SIGSTOP);
      return;
    }
    if (mpiexec_ == 0) end_by(signal);
    last_ = signal;
    if (asks_again(first_) && insisting_ == 0) insisting_ = 1;
    send();
  }

  /// Once more after each second: mpiexec or the ranks may not listen yet. Where mpiexec has not ended within
  /// some seconds of a second request, it is killed, and the ranks with it.
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

/// Open MPI that cannot map its libraries and shared memory crashes with a trace, or hangs.
void refuse_narrow_limit() {
  constexpr rlim_t megabyte = 1 << 20, least = 512;  // mpiexec and one rank have 200 to 300
  const std::optional<std::uintmax_t> limit = address_space_limit();
  if (!limit || *limit >= least * megabyte) return;
  throw InputError("several ranks cannot be started: the address space of a process is limited to " +
                   std::to_string(*limit / megabyte) + " MiB (ulimit -v), and MPI needs " +
                   std::to_string(least));
}

/// A file without a name that holds `text`, to be read from its beginning.
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

/// Copies what is there to the standard output; false at the end. What nobody takes is read all the same:
/// mpiexec ends a run whose output it cannot write.
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

/// Passes the output of a process on until it has ended; its status.
int wait_and_pass_on(pid_t child, int output) {
  constexpr int patience = 100;  // milliseconds between two looks at the process, where it says nothing
  pollfd channel{output, POLLIN, 0};
  int status = 0;
  bool open = true, running = true;
  while (running) {
    running = waitpid(child, &status, open ? WNOHANG : 0) != child;
    // What it has left behind is taken, but who else holds its end is not waited for.
    while (open && poll(&channel, 1, running ? patience : 0) > 0) open = pass_output_on(output);
  }
  return status;
}

[[noreturn]] void become_mpiexec(const std::vector<std::string>& words, int input, int output) {
  // Its own group, so that an interrupt from the keyboard comes once, through pass_on; and no orphan if this
  // program is killed outright.
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  std::signal(stop_signal, SIG_IGN);  // until mpiexec listens to it
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
  // Within a batch script alone, SLURM_STEP_ID is not set: only srun makes steps of several tasks.
  return std::getenv("SLURM_STEP_ID") != nullptr && std::getenv("SLURM_STEP_NUM_TASKS") != nullptr;
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  std::set<std::string> cores;  // hardware threads of one core share their list of siblings
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
  // A node of a tetrahedral mesh brings five and a half elements: some 240 bytes as text for its three
  // unknowns.
  constexpr std::int64_t bytes_per_unknown = 80;
  std::error_code error;
  const auto bytes = mesh.content ? mesh.content->size() : std::filesystem::file_size(*mesh.file, error);
  if (error) return 0;
  // Every refinement has eight times as many unknowns, quadratic tetrahedra some seven times those of linear
  // ones.
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
      // Containers forbid the system call behind single copies; shared memory alone does.
      {"OMPI_MCA_btl_vader_single_copy_mechanism", "none"},
      {"OMPI_MCA_btl", "self,vader"},
      // Without these, even one process looks for ssh and starts a daemon.
      {"OMPI_MCA_plm", "isolated"},
      {"OMPI_MCA_ess_singleton_isolated", "1"},
      {"OMPI_MCA_pml", "ob1"},
      {"OMPI_MCA_btl_base_warn_component_unused", "0"},
      // Waiting ranks let others work: on a busy machine spinning ones hold up the run.
      {"OMPI_MCA_mpi_yield_when_idle", "1"},
      // mpiexec passes SIGTSTP and SIGCONT on to the ranks.
      {"OMPI_MCA_orte_forward_job_control", "1"},
      // Where a rank ends with a code, what is left of the others has nothing to do: no second is waited for
      // them.
      {"OMPI_MCA_odls_base_sigkill_timeout", "0"},
      {"HWLOC_HIDE_ERRORS", "2"},
      // Devices do not matter to a run, and looking at all of them takes a third of a small one.
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
    folder->hand_down();  // the ranks may outlive this process by some seconds
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
  if (signal != 0) {  // it came when there was nothing yet to stop in order
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
