// A library to be loaded before all others (LD_PRELOAD): the write of number TREMIE_FAIL_AT below the folder
// TREMIE_FAIL_IN fails with the error TREMIE_FAIL_WITH; with TREMIE_FAIL_ON=1 every later one, too, as on a full disk.
// Writes are opening for writing, writing, bringing to disk, renaming and making a folder. The number of writes goes
// to the file TREMIE_FAIL_COUNT at the end.

#include <dlfcn.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdlib>
#include <cstring>

namespace {

char folder[PATH_MAX] = "", count_file[PATH_MAX] = "";  // plain: others write before a constructor is run
long fail_at = 0;
int fail_with = EIO;
bool fail_on = false;
std::atomic<long> writes{0};

template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

__attribute__((constructor)) void begin() {
  const auto text = [](const char* name) { return getenv(name) ? getenv(name) : ""; };
  snprintf(folder, sizeof folder, "%s", text("TREMIE_FAIL_IN"));
  snprintf(count_file, sizeof count_file, "%s", text("TREMIE_FAIL_COUNT"));
  fail_at = atol(text("TREMIE_FAIL_AT"));
  if (const int error = atoi(text("TREMIE_FAIL_WITH")); error > 0) fail_with = error;
  fail_on = strcmp(text("TREMIE_FAIL_ON"), "1") == 0;
  unsetenv("LD_PRELOAD");  // charts are drawn by programs of their own
}

__attribute__((destructor)) void end() {
  folder[0] = '\0';
  if (count_file[0] == '\0') return;
  if (FILE* out = next<FILE* (*)(const char*, const char*)>("fopen")(count_file, "w")) {
    fprintf(out, "%ld\n", writes.load());
    fclose(out);
  }
}

/// Whether this write fails.
bool fails(const char* path) {
  if (folder[0] == '\0' || !path || strncmp(path, folder, strlen(folder)) != 0) return false;
  const long n = ++writes;
  if (fail_at == 0 || !(n == fail_at || (fail_on && n > fail_at))) return false;
  errno = fail_with;
  return true;
}

bool fails(int file) {
  char link[64], path[PATH_MAX] = {};
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  return readlink(link, path, sizeof path - 1) > 0 && fails(path);
}

bool writes_by(int flags) { return (flags & O_ACCMODE) != O_RDONLY; }

mode_t mode_of(int flags, va_list& arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

#define TREMIE_OPEN(name)                                                  \
  int name(const char* path, int flags, ...) {                             \
    va_list arguments;                                                     \
    va_start(arguments, flags);                                            \
    const mode_t mode = mode_of(flags, arguments);                         \
    va_end(arguments);                                                     \
    if (writes_by(flags) && fails(path)) return -1;                        \
    return next<int (*)(const char*, int, ...)>(#name)(path, flags, mode); \
  }
TREMIE_OPEN(open)
TREMIE_OPEN(open64)

#define TREMIE_FOPEN(name)                                               \
  FILE* name(const char* path, const char* mode) {                       \
    if (mode[0] != 'r' && fails(path)) return nullptr;                   \
    return next<FILE* (*)(const char*, const char*)>(#name)(path, mode); \
  }
TREMIE_FOPEN(fopen)
TREMIE_FOPEN(fopen64)

ssize_t write(int file, const void* data, size_t n) {
  if (fails(file)) return -1;
  return next<ssize_t (*)(int, const void*, size_t)>("write")(file, data, n);
}
ssize_t writev(int file, const iovec* parts, int n) {
  if (fails(file)) return -1;
  return next<ssize_t (*)(int, const iovec*, int)>("writev")(file, parts, n);
}
ssize_t pwrite(int file, const void* data, size_t n, off_t at) {
  if (fails(file)) return -1;
  return next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite")(file, data, n, at);
}
ssize_t pwrite64(int file, const void* data, size_t n, off64_t at) {
  if (fails(file)) return -1;
  return next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64")(file, data, n, at);
}
size_t fwrite(const void* data, size_t size, size_t n, FILE* file) {
  if (fails(fileno(file))) return 0;
  return next<size_t (*)(const void*, size_t, size_t, FILE*)>("fwrite")(data, size, n, file);
}
int fflush(FILE* file) {
  if (file && fails(fileno(file))) return EOF;
  return next<int (*)(FILE*)>("fflush")(file);
}
int fsync(int file) { return fails(file) ? -1 : next<int (*)(int)>("fsync")(file); }
int syncfs(int file) noexcept { return fails(file) ? -1 : next<int (*)(int)>("syncfs")(file); }
int rename(const char* from, const char* to) noexcept {
  return fails(from) ? -1 : next<int (*)(const char*, const char*)>("rename")(from, to);
}
int renameat2(int at, const char* from, int into, const char* to, unsigned flags) noexcept {
  if (fails(from)) return -1;
  return next<int (*)(int, const char*, int, const char*, unsigned)>("renameat2")(at, from, into, to, flags);
}
int mkdir(const char* path, mode_t mode) noexcept {
  return fails(path) ? -1 : next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

}  // extern "C"
