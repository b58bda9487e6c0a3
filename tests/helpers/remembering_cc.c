/* A C compiler that remembers: what was compiled before, from the same sources in the same way, is a copy.
 *
 * It stands before the compiler in PATH, under its name. `helpers/remembering_cc.py` compiles it, and tells it where
 * the compiler is and by which of its names it is known (COMPILERS), what it is (VERSION), and where objects are kept
 * (STORE).
 *
 * An object depends on the compiler, on the arguments but for the name of the object, and on all files that were read,
 * which the compiler says itself (-MD), and on that no others of their names are found before them. For the compiler, the arguments and the source there is a list of the files that
 * were read the last time; for these and what is in all of them, an object. Whatever is not plain, the compiler does
 * itself: several sources, arguments that are not known here, what has warnings. The current folder does not count; only
 * what debuggers are told names it.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <signal.h>
#include <unistd.h>

enum { NAME = 4096, FOLDERS = 16, TAIL = 2 };

typedef unsigned __int128 Digest; /* after FNV-1a, of words instead of bytes */

static const char *const BAD_VARIABLES[] = {
    "CPATH",
    "C_INCLUDE_PATH",
    "GCC_EXEC_PREFIX",
    "COMPILER_PATH",
    "GCC_COMPARE_DEBUG",
    "DEPENDENCIES_OUTPUT",
    "SUNPRO_DEPENDENCIES",
    "SOURCE_DATE_EPOCH",
};

/* Arguments that change nothing but the object. */
static const char *const KNOWN[] = { "-I", "-D", "-U", "-O",    "-W",        "-std=",
                                     "-f", "-g", "-m", "-pipe", "-pedantic", "-pthread" };

/* Those of them that write other files, or read some that are not named. What -march=native means is a part of VERSION. */
static const char *const OTHERS[] = {
    "-Wp,",          "-Wa,",    "-Wl,",          "-fprofile",      "-ftest-coverage", "-fcallgraph",
    "-fstack-usage", "-fdump",  "-fplugin",      "-fauto-profile", "-flto",           "-fopt-info",
    "-fsave",        "-gsplit", "-mtune=native", "-fmodules",      "-fdiagnostics",   "-frandom",
};

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

static bool one_of(const char *text, const char *const *all, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (begins(text, all[i])) {
            return true;
        }
    }
    return false;
}

#define ONE_OF(text, all) one_of((text), (all), sizeof(all) / sizeof *(all))

static void take(Digest *digest, const void *bytes, size_t n)
{
    const Digest prime = ((Digest)1 << 88) | 0x13B;
    for (size_t i = 0; i < n; i += sizeof(uint64_t)) {
        uint64_t word = 0;
        memcpy(&word, (const char *)bytes + i, n - i < sizeof word ? n - i : sizeof word);
        *digest = (*digest ^ word) * prime;
        *digest = *digest << 61 | *digest >> 67;
    }
    *digest ^= n;
}

static void take_text(Digest *digest, const char *text)
{
    take(digest, text, strlen(text) + 1);
}

static Digest begun(void)
{
    Digest digest = ((Digest)0x6C62272E07BB0142 << 64) | 0x62B821756295C58D;
    take_text(&digest, VERSION);
    return digest;
}

/* A regular file as a whole, with a 0 at its end; NULL if there is none. */
static char *contents(const char *path, size_t *size)
{
    char *text = NULL;
    struct stat about;
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        return NULL;
    }
    if (fstat(file, &about) == 0 && S_ISREG(about.st_mode) && (text = malloc((size_t)about.st_size + 1)) != NULL) {
        size_t done = 0;
        ssize_t n;
        while (done < (size_t)about.st_size && (n = read(file, text + done, (size_t)about.st_size - done)) > 0) {
            done += (size_t)n;
        }
        text[done] = 0;
        *size = done;
        if (done != (size_t)about.st_size) {
            free(text);
            text = NULL;
        }
    }
    close(file);
    return text;
}

/* A file with these bytes; false, and no file, if there is no room. */
static bool put(const char *path, const char *bytes, size_t size)
{
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) {
        return false;
    }
    void (*beyond)(int) = signal(SIGXFSZ, SIG_IGN); /* a limit of the size is no room, too */
    size_t done = 0;
    while (done < size) {
        ssize_t n = write(file, bytes + done, size - done);
        if (n <= 0) {
            break;
        }
        done += (size_t)n;
    }
    signal(SIGXFSZ, beyond);
    if (close(file) != 0 || done != size) {
        unlink(path);
        return false;
    }
    return true;
}

static void stored_name(char *name, const char *kind, Digest digest)
{
    snprintf(name, NAME, "%s/%016llx%016llx.%s", STORE, (unsigned long long)(digest >> 64), (unsigned long long)digest,
             kind);
}

/* Others may read it, or store the same, meanwhile. */
static void store(const char *name, const char *bytes, size_t size)
{
    char part[NAME + 32];
    snprintf(part, sizeof part, "%s.%ld", name, (long)getpid());
    if (put(part, bytes, size) && rename(part, name) != 0) {
        unlink(part);
    }
}

/* What the compiler is asked to do. */
typedef struct {
    const char *source;
    char object[NAME];
    Digest digest;                /* of the compiler, the arguments, the source */
    const char *folders[FOLDERS]; /* in which headers are looked for */
    size_t folder_count;
} Job;

/* Whether it is one object of one source, with arguments that are known. */
static bool is_plain(int argc, char **argv, Job *job)
{
    const char *object = NULL;
    bool is_compiled = false;
    job->source = NULL;
    job->folder_count = 0;
    job->digest = begun();
    for (size_t i = 0; i < sizeof BAD_VARIABLES / sizeof *BAD_VARIABLES; i++) {
        if (getenv(BAD_VARIABLES[i]) != NULL) {
            return false;
        }
    }
    for (int i = 1; i < argc; i++) {
        const char *word = argv[i];
        size_t n = strlen(word);
        if (strcmp(word, "-o") == 0 && i + 1 < argc && object == NULL) {
            object = argv[++i];
            continue;
        }
        if (strcmp(word, "-c") == 0) {
            is_compiled = true;
        } else if (word[0] != '-' && n > 2 && strcmp(word + n - 2, ".c") == 0 && job->source == NULL) {
            job->source = word;
        } else if (!ONE_OF(word, KNOWN) || ONE_OF(word, OTHERS) || n == 2) {
            if (!begins(word, "-O") && strcmp(word, "-g") != 0) {
                return false;
            }
        }
        if (begins(word, "-I")) {
            if (job->folder_count == FOLDERS) {
                return false;
            }
            job->folders[job->folder_count++] = word + 2;
        }
        take_text(&job->digest, word);
    }
    if (!is_compiled || job->source == NULL) {
        return false;
    }
    if (object != NULL) {
        snprintf(job->object, sizeof job->object, "%s", object);
    } else {
        const char *last = strrchr(job->source, '/');
        snprintf(job->object, sizeof job->object, "%s", last != NULL ? last + 1 : job->source);
        job->object[strlen(job->object) - 1] = 'o';
    }
    struct stat about;
    return lstat(job->object, &about) != 0 || S_ISREG(about.st_mode);
}

/* Which folders have a file whose name ends like this one: it might be read instead. */
static void take_others(Digest *digest, const Job *job, const char *file)
{
    const char *last = strrchr(job->source, '/'), *tail = file + strlen(file);
    char other[2 * NAME];
    for (int n = 0; n < TAIL && tail > file; n++) {
        for (tail--; tail > file && tail[-1] != '/'; tail--) {
        }
        for (size_t i = 0; i <= job->folder_count; i++) {
            if (i < job->folder_count) {
                snprintf(other, sizeof other, "%s/%s", job->folders[i], tail);
            } else {
                int length = last != NULL ? (int)(last - job->source + 1) : 0;
                snprintf(other, sizeof other, "%.*s%s", length, job->source, tail);
            }
            char is_there = access(other, F_OK) == 0;
            take(digest, &is_there, 1);
        }
    }
}

/* The name of an object that was made from these files, one on each line; false if one cannot be read. */
static bool digest_of_files(const Job *job, const char *files, Digest *digest)
{
    *digest = job->digest;
    for (const char *at = files; *at != 0;) {
        const char *end = strchrnul(at, '\n');
        char name[NAME];
        size_t size, length = (size_t)(end - at);
        if (length >= sizeof name) {
            return false;
        }
        memcpy(name, at, length);
        name[length] = 0;
        char *text = contents(name, &size);
        if (text == NULL || strstr(text, "__TIME__") != NULL || strstr(text, "__DATE__") != NULL) {
            free(text);
            return false;
        }
        take_text(digest, name);
        take(digest, &size, sizeof size);
        take(digest, text, size);
        free(text);
        take_others(digest, job, name);
        at = *end != 0 ? end + 1 : end;
    }
    return true;
}

/* What the compiler says of the files that it has read, as lines; false if a name has something odd in it. */
static bool as_lines(char *rule)
{
    char *to = rule, *at = strstr(rule, ": ");
    if (at == NULL || strchr(rule, '$') != NULL || strchr(rule, '#') != NULL) {
        return false;
    }
    for (at += 2; *at != 0;) {
        size_t n = strcspn(at, " \\\n");
        if (n > 0) {
            memmove(to, at, n);
            to += n;
            *to++ = '\n';
        }
        at += n;
        if (at[0] == '\\' && at[1] != '\n') {
            return false;
        }
        at += *at != 0;
    }
    if (to > rule) {
        to--;
    }
    *to = 0;
    return to > rule;
}

static bool is_remembered(const Job *job, const char *list)
{
    char name[NAME];
    Digest digest;
    size_t size;
    bool is_done = false;
    char *files = contents(list, &size);
    if (files != NULL && digest_of_files(job, files, &digest)) {
        stored_name(name, "o", digest);
        char *object = contents(name, &size);
        if (object != NULL) {
            unlink(job->object); /* it may have another name, which keeps what it has */
            is_done = put(job->object, object, size);
            utimensat(AT_FDCWD, name, NULL, 0); /* what is not used for long is removed */
            utimensat(AT_FDCWD, list, NULL, 0);
        }
        free(object);
    }
    free(files);
    return is_done;
}

static void remember(const Job *job, const char *list, const char *rule_at)
{
    char name[NAME];
    Digest digest;
    size_t rule_size, size;
    char *rule = contents(rule_at, &rule_size);
    char *object = contents(job->object, &size);
    if (rule != NULL && object != NULL && as_lines(rule) && digest_of_files(job, rule, &digest)) {
        stored_name(name, "o", digest);
        store(name, object, size);
        store(list, rule, strlen(rule));
    }
    free(rule);
    free(object);
}

/* Passes on what the compiler has complained of; true if it has not. */
static bool is_silent(int complaints)
{
    char bytes[1 << 14];
    bool is_empty = true;
    ssize_t n;
    lseek(complaints, 0, SEEK_SET);
    while ((n = read(complaints, bytes, sizeof bytes)) > 0) {
        is_empty = false;
        for (ssize_t done = 0, m; done < n && (m = write(STDERR_FILENO, bytes + done, (size_t)(n - done))) > 0;) {
            done += m;
        }
    }
    return is_empty;
}

/* The compiler, told to say which files it reads; its exit code. It ends when this process does. */
static int compiled(const char *compiler, int argc, char **argv, char *rule_at, int complaints)
{
    char **words = calloc((size_t)argc + 4, sizeof *words);
    if (words == NULL) {
        return 1;
    }
    memcpy(words, argv, (size_t)argc * sizeof *words);
    words[0] = (char *)compiler;
    words[argc] = "-MD";
    words[argc + 1] = "-MF";
    words[argc + 2] = rule_at;
    pid_t parent = getpid(), child = fork();
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (getppid() != parent) {
            _exit(1);
        }
        dup2(complaints, STDERR_FILENO);
        execv(compiler, words);
        _exit(127);
    }
    free(words);
    int status = 0;
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (child > 0 && WIFSIGNALED(status)) {
        signal(WTERMSIG(status), SIG_DFL);
        raise(WTERMSIG(status));
    }
    return child > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

/* Its path; `known_as` becomes that of the first that is the same one under another name. */
static const char *compiler_of(const char *called, const char **known_as)
{
    static const char *const COMPILER[] = { COMPILERS };
    const char *name = strrchr(called, '/');
    name = name != NULL ? name + 1 : called;
    for (size_t i = 0; i < sizeof COMPILER / sizeof *COMPILER; i += 3) {
        if (strcmp(name, COMPILER[i]) == 0) {
            *known_as = COMPILER[i + 2];
            return COMPILER[i + 1];
        }
    }
    fprintf(stderr, "%s: not a compiler\n", called);
    exit(127);
}

int main(int argc, char **argv)
{
    const char *known_as, *compiler = compiler_of(argv[0], &known_as);
    Job job;
    if (is_plain(argc, argv, &job)) {
        char list[NAME], rule_at[] = STORE "/rule-XXXXXX";
        size_t size;
        char *source = contents(job.source, &size);
        if (source != NULL) {
            take_text(&job.digest, known_as);
            take(&job.digest, source, size);
            free(source);
            stored_name(list, "files", job.digest);
            if (is_remembered(&job, list)) {
                return 0;
            }
            int rule = mkstemp(rule_at), complaints = open(STORE, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
            if (rule >= 0 && complaints >= 0) {
                close(rule);
                int code = compiled(compiler, argc, argv, rule_at, complaints);
                if (is_silent(complaints) && code == 0) {
                    remember(&job, list, rule_at);
                }
                unlink(rule_at);
                return code;
            }
            if (rule >= 0) {
                close(rule);
                unlink(rule_at);
            }
        }
    }
    argv[0] = (char *)compiler;
    execv(compiler, argv);
    perror(compiler);
    return 127;
}
