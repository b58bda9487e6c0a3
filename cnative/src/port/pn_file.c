/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* realpath, O_NOFOLLOW, fdopendir */

#include "pn/pn_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pn/pn_arena.h"
#include "pn/pn_num.h"

#ifndef PATH_MAX
#define PATH_MAX 4096
#endif

static char s_root[PATH_MAX]; /* "" : no folder is allowed */
static char s_here[PATH_MAX];
static FILE *s_output;
static bool s_has_output; /* the host has said where; else the standard error output */
static int s_problem;     /* errno of the last operation, 0 if it worked */

bool pn_file_allow(const char *folder)
{
    struct stat about;
    s_root[0] = '\0';
    if ((realpath(folder, s_root) == NULL) || (stat(s_root, &about) != 0) || !S_ISDIR(about.st_mode)) {
        s_root[0] = '\0';
    }
    (void)strcpy(s_here, s_root);
    return s_root[0] != '\0';
}

void pn_file_set_output(FILE *output)
{
    s_output = output;
    s_has_output = true;
}

void pn_print(pn_ctx_t *cx, pn_string_t s)
{
    FILE *out = s_has_output ? s_output : stderr;
    if (pn_ok(cx) && (out != NULL)) {
        (void)fwrite(s.bytes, 1U, s.length, out);
    }
}

static bool has_failed(int problem)
{
    s_problem = problem;
    return false;
}

static bool is_below_root(const char *path)
{
    const size_t n = strlen(s_root);
    return (strncmp(path, s_root, n) == 0) && ((n == 1U) || (path[n] == '/') || (path[n] == '\0'));
}

/* Where a file or folder of that name is, without links in the path: `path` has PATH_MAX bytes. The last part need not
 * exist. False when it is not below the allowed folder. */
static bool find(pn_string_t name, char *path)
{
    s_problem = 0;
    char wanted[PATH_MAX];
    const bool is_absolute = (name.length > 0U) && (name.bytes[0] == '/');
    const size_t start = is_absolute ? 0U : (strlen(s_here) + 1U);
    if ((s_root[0] == '\0') || ((name.length > 0U) && (memchr(name.bytes, '\0', name.length) != NULL))) {
        return has_failed(ENOENT);
    }
    if ((start + name.length + 1U) > sizeof wanted) {
        return has_failed(ENAMETOOLONG);
    }
    if (!is_absolute) {
        (void)memcpy(wanted, s_here, start - 1U);
        wanted[start - 1U] = '/';
    }
    if (name.length > 0U) {
        (void)memcpy(&wanted[start], name.bytes, name.length);
    }
    wanted[start + name.length] = '\0';
    if (realpath(wanted, path) == NULL) {
        /* A file that is to be made: its folder is there. */
        char *slash = strrchr(wanted, '/');
        const char *last = slash + 1;
        if ((errno != ENOENT) || (last[0] == '\0') || (strcmp(last, ".") == 0) || (strcmp(last, "..") == 0)) {
            return has_failed(errno);
        }
        *slash = '\0';
        if (realpath((wanted[0] == '\0') ? "/" : wanted, path) == NULL) {
            return has_failed(errno);
        }
        const size_t n = strlen(path);
        if ((n + strlen(last) + 2U) > (size_t)PATH_MAX) {
            return has_failed(ENAMETOOLONG);
        }
        (void)strcpy(&path[n], (n == 1U) ? "" : "/");
        (void)strcat(path, last);
    }
    return is_below_root(path) || has_failed(ENOENT);
}

static bool note(bool has_worked)
{
    s_problem = has_worked ? 0 : errno;
    return has_worked;
}

/* The same for what must exist. */
static bool find_existing(pn_string_t name, char *path, struct stat *about)
{
    return find(name, path) && note(stat(path, about) == 0);
}

/* --- reading and writing ------------------------------------------------------------------------------------------ */

pn_string_t pn_file_read(pn_ctx_t *cx, pn_string_t name)
{
    char path[PATH_MAX];
    struct stat about;
    pn_string_t text = { "", 0U };
    if (!pn_ok(cx) || !find_existing(name, path, &about)) {
        return text;
    }
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (!note(file >= 0)) {
        return text;
    }
    if (S_ISDIR(about.st_mode)) {
        (void)has_failed(EISDIR);
    } else {
        const size_t size = (size_t)about.st_size;
        char *bytes = pn_arena_alloc(cx, size + 1U);
        size_t length = 0U;
        ssize_t got = 1;
        while ((bytes != NULL) && (length < size) && (got > 0)) {
            got = read(file, &bytes[length], size - length);
            length += (got > 0) ? (size_t)got : 0U;
        }
        if ((bytes != NULL) && note(got >= 0)) {
            bytes[length] = '\0';
            text = (pn_string_t){ bytes, (uint32_t)length };
        }
    }
    (void)close(file);
    return text;
}

int64_t pn_file_open(pn_ctx_t *cx, pn_string_t name, bool is_appended)
{
    s_problem = 0;
    if (!pn_ok(cx) || (s_root[0] == '\0')) {
        return PN_FILE_NOWHERE;
    }
    char path[PATH_MAX];
    if (!find(name, path)) {
        return -1;
    }
    const int file = open(path, O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | (is_appended ? O_APPEND : O_TRUNC), 0666);
    (void)note(file >= 0);
    return file; /* never 0 or 1: the host has those open */
}

void pn_file_write(pn_ctx_t *cx, int64_t handle, pn_string_t text)
{
    if (handle == PN_FILE_OUTPUT) {
        pn_print(cx, text);
    } else if (pn_ok(cx) && (handle > PN_FILE_OUTPUT)) {
        size_t done = 0U;
        while (done < text.length) {
            const ssize_t n = write((int)handle, &text.bytes[done], text.length - done);
            if (n <= 0) {
                break; /* a full disk is not the net's business */
            }
            done += (size_t)n;
        }
    }
}

void pn_file_close(pn_ctx_t *cx, int64_t handle)
{
    if (pn_ok(cx) && (handle > PN_FILE_OUTPUT)) {
        (void)close((int)handle);
    }
}

/* --- folders ------------------------------------------------------------------------------------------------------ */

bool pn_file_change(pn_ctx_t *cx, int64_t what, pn_string_t name)
{
    s_problem = 0;
    if (!pn_ok(cx) || ((s_root[0] == '\0') && ((what == 0) || (what == 3)))) {
        return true;
    }
    char path[PATH_MAX];
    struct stat about;
    if (!find(name, path)) {
        return false;
    }
    switch (what) {
    case 0: return note(mkdir(path, 0777) == 0);
    case 1: return note(rmdir(path) == 0);
    case 2: return note(unlink(path) == 0);
    default:
        if ((stat(path, &about) != 0) || !S_ISDIR(about.st_mode)) {
            return has_failed(ENOENT);
        }
        (void)strcpy(s_here, path);
        return true;
    }
}

bool pn_file_rename(pn_ctx_t *cx, pn_string_t old_name, pn_string_t new_name)
{
    char from[PATH_MAX];
    char to[PATH_MAX];
    return pn_ok(cx) && find(old_name, from) && find(new_name, to) && note(rename(from, to) == 0);
}

bool pn_file_is_folder(pn_ctx_t *cx, pn_string_t name)
{
    char path[PATH_MAX];
    struct stat about;
    return pn_ok(cx) && find_existing(name, path, &about) && S_ISDIR(about.st_mode);
}

int64_t pn_file_size(pn_ctx_t *cx, pn_string_t name)
{
    char path[PATH_MAX];
    struct stat about;
    return (pn_ok(cx) && find_existing(name, path, &about)) ? (int64_t)about.st_size : 0;
}

bool pn_file_may(pn_ctx_t *cx, pn_string_t name, int64_t modes)
{
    char path[PATH_MAX];
    struct stat about;
    const int wanted =
        (((modes & 1) != 0) ? R_OK : 0) | (((modes & 2) != 0) ? W_OK : 0) | (((modes & 4) != 0) ? X_OK : 0);
    return pn_ok(cx) && find_existing(name, path, &about) && (access(path, (wanted == 0) ? F_OK : wanted) == 0);
}

pn_string_t pn_file_full_path(pn_ctx_t *cx, pn_string_t name)
{
    char path[PATH_MAX];
    struct stat about;
    const bool is_there = pn_ok(cx) && find_existing(name, path, &about);
    return is_there ? pn_string_make(cx, path, strlen(path)) : PN_STRING("");
}

pn_string_t pn_file_here(pn_ctx_t *cx)
{
    return (s_here[0] == '\0') ? PN_STRING("/") : pn_string_make(cx, s_here, strlen(s_here));
}

/* The first name in a folder that comes after `after`; false if there is none. */
static bool next_name(DIR *folder, const char *after, char *name)
{
    bool is_found = false;
    rewinddir(folder);
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        const char *here = entry->d_name;
        const bool is_own = (strcmp(here, ".") == 0) || (strcmp(here, "..") == 0);
        if (!is_own && (strcmp(here, after) > 0) && (!is_found || (strcmp(here, name) < 0))
            && (strlen(here) < PATH_MAX)) {
            (void)strcpy(name, here);
            is_found = true;
        }
    }
    return is_found;
}

pn_string_t pn_file_names(pn_ctx_t *cx, pn_string_t name)
{
    char path[PATH_MAX];
    struct stat about;
    pn_string_t names = { "", 0U };
    if (!pn_ok(cx) || !find_existing(name, path, &about)) {
        return names;
    }
    DIR *folder = opendir(path); /* the system's own memory, given back below */
    if (!note(folder != NULL)) {
        return names;
    }
    char last[PATH_MAX] = "";
    char next[PATH_MAX] = "";
    while (pn_ok(cx) && next_name(folder, last, next)) {
        (void)strcpy(last, next);
        const pn_string_t one = { next, (uint32_t)strlen(next) };
        names = pn_string_concat(cx, names, pn_string_concat(cx, one, PN_STRING("/")));
    }
    (void)closedir(folder);
    return names;
}

/* --- problems ----------------------------------------------------------------------------------------------------- */

bool pn_file_has_failed(void)
{
    return s_problem != 0;
}

pn_string_t pn_file_problem(pn_ctx_t *cx)
{
    if (s_problem == 0) {
        return PN_STRING("");
    }
    const char *words = strerror(s_problem);
    return pn_string_make(cx, words, strlen(words));
}

pn_string_t pn_file_problem_name(void)
{
    switch (s_problem) {
    case 0: return PN_STRING("");
    case ENOENT: return PN_STRING("noent");
    case EACCES: return PN_STRING("acces");
    case EPERM: return PN_STRING("perm");
    case EEXIST: return PN_STRING("exist");
    case EISDIR: return PN_STRING("isdir");
    case ENOTDIR: return PN_STRING("notdir");
    case ENOTEMPTY: return PN_STRING("notempty");
    case ENOSPC: return PN_STRING("nospc");
    case EROFS: return PN_STRING("rofs");
    case EMFILE: return PN_STRING("mfile");
    case ENAMETOOLONG: return PN_STRING("nametoolong");
    case ELOOP: return PN_STRING("loop");
    case EBUSY: return PN_STRING("busy");
    case EXDEV: return PN_STRING("xdev");
    case EINVAL: return PN_STRING("inval");
    default: return PN_STRING("io");
    }
}
