// SPDX-License-Identifier: BSD-3-Clause
// A library to be preloaded into the program: makes the n-th file operation fail, or cuts the power.
//
// It counts these operations below the folder KACANOV_FAULT_FOLDER in one process: open, write, flush, sync,
// close, truncate, rename and remove. The other variables are numbers:
// KACANOV_FAULT_AT      the n-th operation fails with the error KACANOV_FAULT_ERRNO (default: no space left);
// KACANOV_FAULT_STAYS   all later operations fail too;
// KACANOV_FAULT_CUT     power fails before the n-th operation: unsynced data and names are lost;
// KACANOV_FAULT_NAMES   names survive the power failure, so that a renamed file exists without its content;
// KACANOV_FAULT_NEW     the n-th `new` after the first counted operation (reading the case is one) throws;
// KACANOV_FAULT_LOG     a file that gets one line per operation, and at the end the number of calls of `new`.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace {

template <class F>
F* next(F*, const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_NEXT, name));
}
#define NEXT(name) next(static_cast<decltype(&::name)>(nullptr), #name)

long number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::atol(text) : 0;
}

bool given(const char* variable) { return std::getenv(variable) != nullptr; }

thread_local bool busy = false;  // inside this library
long count = 0, news = 0, failing_new = 0;
bool counting_news = false;

struct Busy {
  bool before = std::exchange(busy, true);
  ~Busy() { busy = before; }
};

std::string absolute(const char* path) {
  if (path[0] == '/') return path;
  char here[4096];
  return std::string(::getcwd(here, sizeof here) != nullptr ? here : "") + "/" + path;
}

bool below(const std::string& path) {
  const char* folder = std::getenv("KACANOV_FAULT_FOLDER");
  return folder != nullptr && path.compare(0, std::strlen(folder), folder) == 0;
}

std::string path_of(int handle) {
  char target[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(handle);
  const ssize_t size = ::readlink(link.c_str(), target, sizeof target);
  return size > 0 ? std::string(target, static_cast<std::size_t>(size)) : std::string();
}

/// A change of a name that its folder has not synced; `kept` is a second name of the previous content.
struct Change {
  std::string path, kept;
};
/// A file with unsynced data.
struct Dirty {
  ino_t inode;
  std::string path;
};
std::vector<Change>& changes() {
  static std::vector<Change> all;
  return all;
}
std::vector<Dirty>& dirty() {
  static std::vector<Dirty> all;
  return all;
}

bool cutting() { return given("KACANOV_FAULT_CUT"); }

void say(const std::string& line) {
  const char* log = std::getenv("KACANOV_FAULT_LOG");
  if (log == nullptr) return;
  const int handle = NEXT(open)(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (handle < 0 || ::write(handle, line.data(), line.size()) < 0) std::perror("log");
  if (handle >= 0) ::close(handle);
}

struct AtEnd {
  ~AtEnd() {
    const Busy here;
    if (counting_news) say("new " + std::to_string(news) + "\n");
  }
} at_end;

[[noreturn]] void cut() {
  for (const Dirty& file : dirty()) {
    struct stat status {};
    if (::stat(file.path.c_str(), &status) == 0 && status.st_ino == file.inode &&
        ::truncate(file.path.c_str(), 0) != 0)
      std::perror("truncate");
  }
  for (auto change = changes().rbegin(); change != changes().rend(); ++change) {
    const bool back = !given("KACANOV_FAULT_NAMES");
    if (change->kept.empty()) {
      if (back) NEXT(unlink)(change->path.c_str());
    } else if (back) {
      NEXT(rename)(change->kept.c_str(), change->path.c_str());
    } else {
      NEXT(unlink)(change->kept.c_str());
    }
  }
  _exit(137);
}

/// Counts an operation and returns whether it has to fail; ends the process at the simulated power failure.
bool fails(const char* what, const std::string& path) {
  failing_new = number_of("KACANOV_FAULT_NEW");
  counting_news = true;
  ++count;
  say(std::string(what) + " " + path + "\n");
  if (cutting() && count == number_of("KACANOV_FAULT_CUT")) cut();
  const long at = number_of("KACANOV_FAULT_AT");
  if (at == 0 || count < at || (count > at && !given("KACANOV_FAULT_STAYS"))) return false;
  const long error = number_of("KACANOV_FAULT_ERRNO");
  errno = error != 0 ? static_cast<int>(error) : ENOSPC;
  return true;
}

void written(int handle) {
  struct stat status {};
  if (!cutting() || ::fstat(handle, &status) != 0) return;
  for (const Dirty& file : dirty())
    if (file.inode == status.st_ino) return;
  dirty().push_back({status.st_ino, path_of(handle)});
}

/// Keeps the current content of a name, in case the change is lost.
void keep(const std::string& path) {
  if (!cutting()) return;
  Change change{path, ""};
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) {
    change.kept = path + ".cut" + std::to_string(changes().size());
    if (::link(path.c_str(), change.kept.c_str()) != 0) std::perror("link");
  }
  changes().push_back(change);
}

/// Opens a stream like fopen, for both of its symbols.
template <class Real>
std::FILE* open_stream(Real real, const char* path, const char* mode) {
  if (busy) return real(path, mode);
  const Busy here;
  const std::string name = absolute(path);
  if (below(name)) {
    if (fails("open", name)) return nullptr;
    if (mode[0] != 'r' && ::access(path, F_OK) != 0) keep(name);
  }
  return real(path, mode);
}

/// Removes a name, for the two functions that do so.
template <class Real>
int take_away(Real real, const char* path) {
  if (busy) return real(path);
  const Busy here;
  const std::string name = absolute(path);
  if (below(name) && ::access(path, F_OK) == 0) {
    if (fails("remove", name)) return -1;
    keep(name);
  }
  return real(path);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  const auto real = NEXT(open);
  if (busy) return real(path, flags, mode);
  const Busy here;
  const std::string name = absolute(path);
  if (below(name)) {
    if (fails("open", name)) return -1;
    if ((flags & O_CREAT) != 0 && ::access(path, F_OK) != 0) keep(name);
  }
  return real(path, flags, mode);
}

std::FILE* fopen(const char* path, const char* mode) { return open_stream(NEXT(fopen), path, mode); }
std::FILE* fopen64(const char* path, const char* mode) { return open_stream(NEXT(fopen64), path, mode); }

size_t fwrite(const void* data, size_t size, size_t entries, FILE* file) {
  const auto real = NEXT(fwrite);
  if (busy || file == stdout || file == stderr) return real(data, size, entries, file);
  const Busy here;
  const std::string name = path_of(fileno(file));
  if (below(name)) {
    if (fails("write", name)) return 0;
    written(fileno(file));
  }
  return real(data, size, entries, file);
}

ssize_t pwrite(int handle, const void* data, size_t size, off_t at) {
  const auto real = NEXT(pwrite);
  if (busy) return real(handle, data, size, at);
  const Busy here;
  const std::string name = path_of(handle);
  if (below(name) && fails("write", name)) return -1;
  return real(handle, data, size, at);
}

int fflush(FILE* file) {
  const auto real = NEXT(fflush);
  if (busy || file == nullptr || file == stdout || file == stderr) return real(file);
  const Busy here;
  const std::string name = path_of(fileno(file));
  if (below(name) && fails("flush", name)) return EOF;
  return real(file);
}

int fsync(int handle) {
  const auto real = NEXT(fsync);
  if (busy) return real(handle);
  const Busy here;
  const std::string name = path_of(handle);
  if (!below(name)) return real(handle);
  if (fails("sync", name)) return -1;
  struct stat status {};
  if (::fstat(handle, &status) == 0 && S_ISDIR(status.st_mode)) {
    for (const Change& change : changes())
      if (!change.kept.empty()) NEXT(unlink)(change.kept.c_str());
    changes().clear();
  } else {
    std::erase_if(dirty(), [&](const Dirty& file) { return file.inode == status.st_ino; });
  }
  return cutting() ? 0 : real(handle);
}

int fclose(FILE* file) {
  const auto real = NEXT(fclose);
  if (busy || file == stdout || file == stderr) return real(file);
  const Busy here;
  const std::string name = path_of(fileno(file));
  if (below(name) && (fcntl(fileno(file), F_GETFL) & (O_WRONLY | O_RDWR)) != 0 && fails("close", name)) {
    const int error = errno;
    real(file);
    errno = error;
    return EOF;
  }
  return real(file);
}

int ftruncate(int handle, off_t size) {
  const auto real = NEXT(ftruncate);
  if (busy) return real(handle, size);
  const Busy here;
  const std::string name = path_of(handle);
  if (below(name) && fails("truncate", name)) return -1;
  return real(handle, size);
}

int rename(const char* from, const char* to) {
  const auto real = NEXT(rename);
  if (busy) return real(from, to);
  const Busy here;
  const std::string name = absolute(to), old = absolute(from);
  if (!below(name)) return real(from, to);
  if (fails("rename", name)) return -1;
  keep(name);
  for (Dirty& file : dirty())
    if (file.path == old) file.path = name;
  // The temporary name was new too: undoing the rename must not restore it.
  std::erase_if(changes(), [&](const Change& change) { return change.path == old && change.kept.empty(); });
  return real(from, to);
}

int unlink(const char* path) { return take_away(NEXT(unlink), path); }
int remove(const char* path) { return take_away(NEXT(remove), path); }

}  // extern "C"

void* operator new(std::size_t size) {
  const bool failing = counting_news && !busy && ++news == failing_new;
  if (void* memory = failing ? nullptr : std::malloc(size)) return memory;
  if (const std::new_handler handler = std::get_new_handler()) handler();
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) { return ::operator new(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
