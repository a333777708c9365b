/* Lets one call of the system fail: the n-th of a kind that concerns a file below a folder.

   cc -shared -fPIC -o shim.so shim.c -ldl; loaded before the C library (LD_PRELOAD).
   fault_arm(kind, number, error, folder) begins to count; number 0 lets none fail.  fault_count(kind) is how many there were. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum { WRITE, SYNC, RENAME, TRUNCATE, LINK, OPEN, MKDIR, KINDS };

static char folder[4096];
static int armed_kind = -1, armed_error;
static long armed_number, counts[KINDS];

void fault_arm(int kind, long number, int error, const char *below) {
    memset(counts, 0, sizeof counts);
    armed_kind = kind, armed_number = number, armed_error = error;
    snprintf(folder, sizeof folder, "%s", below);
}

long fault_count(int kind) { return counts[kind]; }

static int fails(int kind, const char *path) {
    if (!folder[0] || strncmp(path, folder, strlen(folder))) return 0;
    long number = __sync_add_and_fetch(&counts[kind], 1);
    if (kind != armed_kind || number != armed_number) return 0;
    errno = armed_error;
    return 1;
}

static int fails_on(int kind, int descriptor) {
    if (!folder[0]) return 0;
    char name[64], path[4096];
    snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
    ssize_t length = readlink(name, path, sizeof path - 1);
    if (length < 0) return 0;
    path[length] = 0;
    return fails(kind, path);
}

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define ON_DESCRIPTOR(kind, type, name, parameters, arguments) \
    type name parameters { return fails_on(kind, descriptor) ? -1 : REAL(name) arguments; }
#define ON_PATH(kind, name, parameters, arguments) \
    int name parameters { return fails(kind, path) ? -1 : REAL(name) arguments; }

ON_DESCRIPTOR(WRITE, ssize_t, write, (int descriptor, const void *data, size_t n), (descriptor, data, n))
ON_DESCRIPTOR(WRITE, ssize_t, pwrite, (int descriptor, const void *data, size_t n, off_t at), (descriptor, data, n, at))
ON_DESCRIPTOR(WRITE, ssize_t, pwrite64, (int descriptor, const void *data, size_t n, off64_t at), (descriptor, data, n, at))
ON_DESCRIPTOR(WRITE, ssize_t, writev, (int descriptor, const struct iovec *data, int n), (descriptor, data, n))
ON_DESCRIPTOR(SYNC, int, fsync, (int descriptor), (descriptor))
ON_DESCRIPTOR(SYNC, int, fdatasync, (int descriptor), (descriptor))
ON_DESCRIPTOR(TRUNCATE, int, ftruncate, (int descriptor, off_t size), (descriptor, size))
ON_DESCRIPTOR(TRUNCATE, int, ftruncate64, (int descriptor, off64_t size), (descriptor, size))
ON_PATH(TRUNCATE, truncate, (const char *path, off_t size), (path, size))
ON_PATH(TRUNCATE, truncate64, (const char *path, off64_t size), (path, size))
ON_PATH(RENAME, rename, (const char *path, const char *other), (path, other))
ON_PATH(LINK, link, (const char *path, const char *other), (path, other))
ON_PATH(MKDIR, mkdir, (const char *path, mode_t mode), (path, mode))

ssize_t sendfile(int descriptor, int source, off_t *at, size_t n) {
    return fails_on(WRITE, descriptor) ? -1 : ((ssize_t(*)(int, int, off_t *, size_t))dlsym(RTLD_NEXT, "sendfile"))(descriptor, source, at, n);
}

ssize_t sendfile64(int descriptor, int source, off64_t *at, size_t n) {
    return fails_on(WRITE, descriptor) ? -1 : ((ssize_t(*)(int, int, off64_t *, size_t))dlsym(RTLD_NEXT, "sendfile64"))(descriptor, source, at, n);
}

#define OPENER(name)                                                                          \
    int name(const char *path, int flags, ...) {                                              \
        va_list rest;                                                                         \
        va_start(rest, flags);                                                                \
        mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0;               \
        va_end(rest);                                                                         \
        return flags & O_CREAT && fails(OPEN, path) ? -1 : REAL(name)(path, flags, mode);     \
    }
OPENER(open)
OPENER(open64)
