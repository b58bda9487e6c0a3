/* SPDX-License-Identifier: MIT
 * kept_cc.c - the C compiler of the tests: it compiles the same text with the same flags once a session, whichever test asks.
 *
 *   KEPT_OBJECTS=/tmp/objects kept/commands/gcc -O2 -c a.c -o a.o      kept/real/gcc is a link to the compiler
 *
 * The name of a kept object file is a hash of the flags and of the preprocessed text, so it is the one that the compiler would make
 * now. Only what was compiled without a word is kept. Each .c file of a call is compiled by itself, then linked if that was asked for.
 * Whatever is not known for certain (other modes, other languages, no KEPT_OBJECTS) is left to the compiler as it stands.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST = 1024 };

typedef unsigned __int128 hash_t;

static const char *s_real;
static const char *s_kept;
static char **s_argument;

static void fail(const char *what)
{
    perror(what);
    exit(1);
}

static _Noreturn void leave_to_compiler(void)
{
    s_argument[0] = (char *)s_real;
    (void)execv(s_real, s_argument);
    perror(s_real);
    exit(127);
}

static hash_t hashed(hash_t sum, const void *bytes, size_t length)
{
    const hash_t prime = ((hash_t)1 << 88) + 0x13BU; /* FNV-1a, 128 bits */
    const unsigned char *const at = bytes;
    for (size_t i = 0U; i < length; i++) {
        sum = (sum ^ at[i]) * prime;
        sum ^= sum >> 67U;
    }
    return sum;
}

static bool ends_in(const char *text, const char *end)
{
    const size_t a = strlen(text);
    const size_t b = strlen(end);
    return (a > b) && (strcmp(text + a - b, end) == 0);
}

static bool begins(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

static char *joined(const char *a, const char *b, const char *c)
{
    char *text = NULL;
    if (asprintf(&text, "%s%s%s", a, b, c) < 0) {
        fail("kept_cc");
    }
    return text;
}

/* A child of this process with these arguments; its output, or its errors, come through *stream. */
static pid_t started(char *const argv[], int captured, int *stream)
{
    int ends[2] = { -1, -1 };
    if ((captured >= 0) && (pipe(ends) != 0)) {
        fail("pipe");
    }
    const pid_t child = vfork();
    if (child == 0) {
        if (captured >= 0) {
            (void)dup2(ends[1], captured);
            (void)close(ends[0]);
            (void)close(ends[1]);
        }
        (void)execv(s_real, argv);
        _exit(127);
    }
    if (child < 0) {
        fail("fork");
    }
    if (captured >= 0) {
        (void)close(ends[1]);
        *stream = ends[0];
    }
    return child;
}

static int code_of(pid_t child)
{
    int status = 0;
    while ((waitpid(child, &status, 0) < 0) && (errno == EINTR)) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : (128 + WTERMSIG(status));
}

/* The flags without the sources, the target and -c; for the compiler with `more` behind them. */
static char **with(char *const flags[], int count, const char *const more[])
{
    char **const argv = calloc((size_t)count + 8U, sizeof *argv);
    int n = 0;
    argv[n++] = (char *)s_real;
    for (int i = 0; i < count; i++) {
        argv[n++] = flags[i];
    }
    for (int i = 0; more[i] != NULL; i++) {
        argv[n++] = (char *)more[i];
    }
    return argv;
}

/* False: it cannot be preprocessed. */
static bool name_of(char *const flags[], int count, const char *source, char name[40])
{
    static char block[1 << 16];
    hash_t sum = ((hash_t)0x6C62272E07BB0142U << 64) + 0x62B821756295C58DU;
    sum = hashed(sum, s_real, strlen(s_real) + 1U);
    for (int i = 0; i < count; i++) {
        if (!begins(flags[i], "-I")) {
            sum = hashed(sum, flags[i], strlen(flags[i]) + 1U);
        }
    }
    const char *const more[] = { "-E", "-fno-working-directory", source, NULL };
    int text = -1;
    const pid_t child = started(with(flags, count, more), STDOUT_FILENO, &text);
    ssize_t length = 0;
    while ((length = read(text, block, sizeof block)) > 0) {
        sum = hashed(sum, block, (size_t)length);
    }
    (void)close(text);
    (void)snprintf(name, 40U, "%016llx%016llx", (unsigned long long)(sum >> 64), (unsigned long long)sum);
    return (length == 0) && (code_of(child) == 0);
}

/* The same bytes under another name, at once; false: they are not there, or there is no room. */
static bool copied(const char *from, const char *to)
{
    static char block[1 << 16];
    char number[32];
    (void)snprintf(number, sizeof number, ".%ld", (long)getpid());
    char *const own = joined(to, number, "");
    const int in = open(from, O_RDONLY | O_CLOEXEC);
    const int out = (in >= 0) ? open(own, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666) : -1;
    ssize_t length = 0;
    bool is_fine = (out >= 0);
    while (is_fine && ((length = read(in, block, sizeof block)) > 0)) {
        is_fine = (write(out, block, (size_t)length) == length);
    }
    is_fine = is_fine && (length == 0);
    if (in >= 0) {
        (void)close(in);
    }
    if (out >= 0) {
        is_fine = (close(out) == 0) && is_fine && (rename(own, to) == 0);
        if (!is_fine) {
            (void)unlink(own);
        }
    }
    return is_fine;
}

/* One source to one object file: the exit code. */
static int compile(char *const flags[], int count, const char *source, const char *target)
{
    static char said[1 << 16];
    char name[40];
    const char *const more[] = { "-c", source, "-o", target, NULL };
    char *const *const argv = with(flags, count, more);
    if (!name_of(flags, count, source, name)) {
        return code_of(started(argv, -1, NULL)); /* it says why */
    }
    char *const kept = joined(s_kept, "/", name);
    if (copied(kept, target)) {
        return 0;
    }
    char *const lock = joined(kept, ".lock", "");
    const int gate = open(lock, O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (gate >= 0) {
        (void)flock(gate, LOCK_EX); /* another process may be compiling just that */
        if (copied(kept, target)) {
            return 0;
        }
    }
    int errors = -1;
    const pid_t child = started(argv, STDERR_FILENO, &errors);
    bool is_silent = true;
    ssize_t length = 0;
    while ((length = read(errors, said, sizeof said)) > 0) {
        is_silent = false;
        (void)!write(STDERR_FILENO, said, (size_t)length);
    }
    const int code = code_of(child);
    if ((code == 0) && is_silent) {
        (void)copied(target, kept);
    }
    return code;
}

static char *object_beside(const char *source)
{
    const char *const slash = strrchr(source, '/');
    char *const name = joined((slash != NULL) ? slash + 1 : source, "", "");
    name[strlen(name) - 1U] = 'o';
    return name;
}

/* What the link says that is called as this program is. */
static char *real_compiler(void)
{
    char own[4096];
    char *const link = malloc(2U * sizeof own);
    ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1U);
    if ((link == NULL) || (length <= 0)) {
        fail("/proc/self/exe");
    }
    own[length] = '\0';
    char *const name = strrchr(own, '/');
    *name = '\0';
    (void)snprintf(link, 2U * sizeof own, "%s/../real/%s", own, name + 1);
    length = readlink(link, own, sizeof own - 1U);
    if (length <= 0) {
        fail(link);
    }
    own[length] = '\0';
    return strcpy(link, own);
}

int main(int argc, char **argv)
{
    static char *flag[MOST];
    static char *part[MOST]; /* of the linker: in their order, sources as their object files */
    static char *source[MOST];
    static char *object[MOST];
    int flags = 0;
    int parts = 0;
    int sources = 0;
    bool compiles = false;
    const char *target = NULL;
    s_argument = argv;
    s_real = real_compiler();
    s_kept = getenv("KEPT_OBJECTS");
    if ((s_kept == NULL) || (argc >= MOST)) {
        leave_to_compiler();
    }
    for (int i = 1; i < argc; i++) {
        char *const a = argv[i];
        /* Of options with an argument of their own only -o is known. */
        static const char *const other[] = { "@", "--", "-E", "-S", "-M", "-x", "-v", "-X", "-T", "-B", "-i", "-save-temps", "-print",
                                             "-dump", "-fanalyzer", "-fsyntax-only", "-Wp,", "-aux", "-spec", "-wrapper" };
        static const char *const alone[] = { "-I", "-D", "-U", "-L", "-l", "-u", "-z", "-e", "-h", "-A", "-" };
        for (size_t k = 0U; k < sizeof other / sizeof other[0]; k++) {
            if (begins(a, other[k])) {
                leave_to_compiler();
            }
        }
        for (size_t k = 0U; k < sizeof alone / sizeof alone[0]; k++) {
            if (strcmp(a, alone[k]) == 0) {
                leave_to_compiler();
            }
        }
        if (strcmp(a, "-c") == 0) {
            compiles = true;
        } else if ((strcmp(a, "-o") == 0) && ((i + 1) < argc)) {
            target = argv[++i];
        } else if (a[0] != '-') {
            if (ends_in(a, ".c")) {
                source[sources] = a;
                object[sources] = NULL;
                part[parts++] = NULL;
                sources++;
            } else if (ends_in(a, ".o") || ends_in(a, ".a") || ends_in(a, ".so") || (strchr(a, '.') == NULL)) {
                part[parts++] = a;
            } else {
                leave_to_compiler();
            }
        } else if (begins(a, "-l") || begins(a, "-L") || begins(a, "-Wl,") || (strcmp(a, "-shared") == 0) || (strcmp(a, "-rdynamic") == 0)) {
            part[parts++] = a;
        } else {
            flag[flags++] = a;
            part[parts++] = a;
        }
    }
    if ((sources == 0) || (compiles && (target != NULL) && (sources > 1))) {
        leave_to_compiler();
    }
    char folder[] = "/tmp/kept-cc-XXXXXX";
    if (!compiles && (mkdtemp(folder) == NULL)) {
        leave_to_compiler();
    }
    int code = 0;
    for (int i = 0; (i < sources) && (code == 0); i++) {
        if (compiles) {
            object[i] = (target != NULL) ? (char *)target : object_beside(source[i]);
        } else {
            char number[24];
            (void)snprintf(number, sizeof number, "/%d.o", i);
            object[i] = joined(folder, number, "");
        }
        code = compile(flag, flags, source[i], object[i]);
    }
    if (compiles) {
        return code;
    }
    if (code == 0) {
        const char *const out[] = { "-o", (target != NULL) ? target : "a.out", NULL };
        int k = 0;
        for (int i = 0; i < parts; i++) {
            part[i] = (part[i] != NULL) ? part[i] : object[k++];
        }
        code = code_of(started(with(part, parts, out), -1, NULL));
    }
    for (int i = 0; i < sources; i++) {
        if (object[i] != NULL) {
            (void)unlink(object[i]);
        }
    }
    (void)rmdir(folder);
    return code;
}
