/* Counts the calls of a process, and of those it starts, that touch files below given folders,
   and makes the n-th of them fail, come short, or be the last that the process does.

   Loaded before the C library (LD_PRELOAD), so that what netCDF and HDF5 do is seen too.  What is
   to happen stands in a mapped file that all processes share (FAULTS), laid out as `struct plan`;
   calls.py beside this file writes it. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

enum { BEFORE = 1001, AFTER, TORN, SHORT }; /* killed before, after, within; fewer bytes */

struct plan {
    long armed, at, how, kinds, then, told; /* then: kinds that fail from then on; told: write down */
    _Atomic long count, done;
    char folders[2048]; /* each ends with a newline */
    char record[1024];  /* where calls are written down */
};

static struct plan *plan;

/* symbols of the C library that came with later versions are looked up, never linked */
#define REAL(name) \
    static __typeof__(name) *real; \
    if (!real) real = (__typeof__(name) *)dlsym(RTLD_NEXT, #name)

__attribute__((constructor)) static void start(void) {
    const char *path = getenv("FAULTS");
    int file = path ? syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) return;
    plan = mmap(NULL, sizeof *plan, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (plan == MAP_FAILED) plan = NULL;
    syscall(SYS_close, file);
}

static int is_below(const char *path) {
    const char *folder = plan->folders;
    while (*folder) {
        size_t n = strcspn(folder, "\n");
        if (!strncmp(path, folder, n) && (path[n] == '/' || !path[n])) return 1;
        folder += n + (folder[n] == '\n');
    }
    return 0;
}

static const char *of_name(int at, const char *name, char *path) {
    char link[64];
    ssize_t n = 0;
    if (name[0] == '/') return name;
    snprintf(link, sizeof link, at == AT_FDCWD ? "/proc/self/cwd" : "/proc/self/fd/%d", at);
    n = syscall(SYS_readlinkat, AT_FDCWD, link, path, 4000);
    if (n < 0) return name;
    snprintf(path + n, 4096 - n, "/%s", name);
    return path;
}

static const char *of_handle(int file, char *path) {
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t n = syscall(SYS_readlinkat, AT_FDCWD, link, path, 4000);
    if (n < 0) return "";
    path[n] = 0;
    return path;
}

static void die(void) {
    atomic_fetch_add(&plan->done, 1);
    kill(getpid(), SIGKILL);
    for (;;) pause();
}

/* what is to happen to this call: 0, an error, or one of the ways above */
static int fate(int kind, const char *what, const char *path) {
    if (!plan->armed || !is_below(path)) return 0;
    if (plan->done && plan->then >> kind & 1) {
        atomic_fetch_add(&plan->done, 1);
        return plan->how;
    }
    if (!(plan->kinds >> kind & 1)) return 0;
    long n = atomic_fetch_add(&plan->count, 1) + 1;
    if (plan->told) {
        char line[4200];
        int size = snprintf(line, sizeof line, "%ld %s %s\n", n, what, path);
        int file = syscall(SYS_openat, AT_FDCWD, plan->record, O_WRONLY | O_APPEND | O_CREAT, 0644);
        syscall(SYS_write, file, line, size);
        syscall(SYS_close, file);
    }
    if (n != plan->at) return 0;
    if (plan->how == BEFORE || (plan->how == TORN && kind != 0)) die();
    atomic_fetch_add(&plan->done, 1);
    if (plan->how == SHORT && kind != 0) return 0;
    return plan->how;
}

/* kinds: 0 write, 1 open to write, 2 open to read, 3 read, 4 fsync, 5 rename, 6 unlink, 7 mkdir,
   8 stat, 9 close, 10 ftruncate, 11 list, 12 link */
#define ON(kind, path_of) \
    char path[4096]; \
    int how = plan ? fate(kind, __func__, path_of) : 0; \
    if (how > 0 && how < BEFORE) { errno = how; return -1; }
#define GIVE(call) \
    __typeof__(call) given = call; \
    if (how == AFTER) die(); \
    return given

#define WRITE(name, extra, given_extra) \
    ssize_t name(int file, const void *data, size_t size extra) { \
        REAL(name); \
        ON(0, of_handle(file, path)); \
        if ((how == TORN || how == SHORT) && size > 1) size /= 2; \
        ssize_t given = real(file, data, size given_extra); \
        if (how == AFTER || how == TORN) die(); \
        return given; \
    }
#define COMMA ,
WRITE(write, , )
WRITE(pwrite, COMMA off_t place, COMMA place)
WRITE(pwrite64, COMMA off64_t place, COMMA place)

#define READ(name, extra, given_extra) \
    ssize_t name(int file, void *data, size_t size extra) { \
        REAL(name); \
        ON(3, of_handle(file, path)); \
        GIVE(real(file, data, size given_extra)); \
    }
READ(read, , )
READ(pread, COMMA off_t place, COMMA place)
READ(pread64, COMMA off64_t place, COMMA place)

#define MODE \
    mode_t mode = 0; \
    if (flags & (O_CREAT | __O_TMPFILE)) { \
        va_list more; \
        va_start(more, flags); \
        mode = va_arg(more, mode_t); \
        va_end(more); \
    }
#define TO_WRITE(flags) ((flags) & (O_WRONLY | O_RDWR | O_CREAT) ? 1 : 2)
#define OPEN(name) \
    int name(const char *file, int flags, ...) { \
        REAL(name); \
        MODE; \
        ON(TO_WRITE(flags), of_name(AT_FDCWD, file, path)); \
        GIVE(real(file, flags, mode)); \
    }
OPEN(open)
OPEN(open64)
#define OPEN_AT(name) \
    int name(int at, const char *file, int flags, ...) { \
        REAL(name); \
        MODE; \
        ON(TO_WRITE(flags), of_name(at, file, path)); \
        GIVE(real(at, file, flags, mode)); \
    }
OPEN_AT(openat)
OPEN_AT(openat64)

#define FOPEN(name) \
    FILE *name(const char *file, const char *mode) { \
        REAL(name); \
        char path[4096]; \
        int how = plan ? fate(mode[0] == 'r' && !strchr(mode, '+') ? 2 : 1, __func__, \
                              of_name(AT_FDCWD, file, path)) : 0; \
        if (how > 0 && how < BEFORE) { errno = how; return NULL; } \
        GIVE(real(file, mode)); \
    }
FOPEN(fopen)
FOPEN(fopen64)

DIR *opendir(const char *folder) {
    REAL(opendir);
    char path[4096];
    int how = plan ? fate(11, __func__, of_name(AT_FDCWD, folder, path)) : 0;
    if (how > 0 && how < BEFORE) { errno = how; return NULL; }
    GIVE(real(folder));
}

#define ON_HANDLE(kind, name, extra, given_extra) \
    int name(int file extra) { \
        REAL(name); \
        ON(kind, of_handle(file, path)); \
        GIVE(real(file given_extra)); \
    }
ON_HANDLE(4, fsync, , )
ON_HANDLE(4, fdatasync, , )
ON_HANDLE(10, ftruncate, COMMA off_t size, COMMA size)
ON_HANDLE(10, ftruncate64, COMMA off64_t size, COMMA size)
ON_HANDLE(8, fstat, COMMA struct stat *state, COMMA state)
ON_HANDLE(8, fstat64, COMMA struct stat64 *state, COMMA state)

/* the handle is gone even where the system says that what was written is lost */
int close(int file) {
    REAL(close);
    char path[4096];
    int how = plan ? fate(9, __func__, of_handle(file, path)) : 0;
    int given = real(file);
    if (how == AFTER) die();
    if (how > 0 && how < BEFORE) { errno = how; return -1; }
    return given;
}

#define ON_NAME(kind, name, extra, given_extra) \
    int name(const char *file extra) { \
        REAL(name); \
        ON(kind, of_name(AT_FDCWD, file, path)); \
        GIVE(real(file given_extra)); \
    }
ON_NAME(6, unlink, , )
ON_NAME(6, rmdir, , )
ON_NAME(7, mkdir, COMMA mode_t mode, COMMA mode)
ON_NAME(8, stat, COMMA struct stat *state, COMMA state)
ON_NAME(8, stat64, COMMA struct stat64 *state, COMMA state)
ON_NAME(8, lstat, COMMA struct stat *state, COMMA state)
ON_NAME(8, lstat64, COMMA struct stat64 *state, COMMA state)

#define ON_NAME_AT(kind, name, extra, given_extra) \
    int name(int at, const char *file extra) { \
        REAL(name); \
        ON(kind, of_name(at, file, path)); \
        GIVE(real(at, file given_extra)); \
    }
ON_NAME_AT(6, unlinkat, COMMA int flags, COMMA flags)
ON_NAME_AT(7, mkdirat, COMMA mode_t mode, COMMA mode)
ON_NAME_AT(8, fstatat, COMMA struct stat *state COMMA int flags, COMMA state COMMA flags)
ON_NAME_AT(8, fstatat64, COMMA struct stat64 *state COMMA int flags, COMMA state COMMA flags)

#define TWO_NAMES(kind, name) \
    int name(const char *from, const char *to) { \
        REAL(name); \
        ON(kind, of_name(AT_FDCWD, to, path)); \
        GIVE(real(from, to)); \
    }
TWO_NAMES(5, rename)
TWO_NAMES(12, link)
int renameat(int from_at, const char *from, int to_at, const char *to) {
    REAL(renameat);
    ON(5, of_name(to_at, to, path));
    GIVE(real(from_at, from, to_at, to));
}
int linkat(int from_at, const char *from, int to_at, const char *to, int flags) {
    REAL(linkat);
    ON(12, of_name(to_at, to, path));
    GIVE(real(from_at, from, to_at, to, flags));
}

/* what programs call that were built with older versions of the C library */
#define OLD_STAT(name, first) \
    int name(int version, first file, struct stat *state); \
    int name(int version, first file, struct stat *state) { \
        REAL(name); \
        ON(8, OF(file)); \
        GIVE(real(version, file, state)); \
    }
#define OF(file) of_name(AT_FDCWD, file, path)
OLD_STAT(__xstat, const char *)
OLD_STAT(__xstat64, const char *)
OLD_STAT(__lxstat, const char *)
OLD_STAT(__lxstat64, const char *)
#undef OF
#define OF(file) of_handle(file, path)
OLD_STAT(__fxstat, int)
OLD_STAT(__fxstat64, int)
