/* SPDX-License-Identifier: MIT
 * conform_port.c - the operating system as a program under test sees it: files in memory, a clock that stands, a state
 * that can be saved and restored. It takes the place of port_posix.c; everything above it is the deployed supervisor,
 * byte for byte.
 *
 * The supervisor goes round its cycle and waits. There it is asked, line by line on standard input, and answers by a
 * line of JSON:
 *
 *     push              saves the state: {"pushed": true}. The state is the process: it waits while a copy of it goes
 *                       on
 *     pop               goes back to the state saved last: {"popped": true}
 *     write NAME BYTES  another party publishes a file (name and bytes in hexadecimal): {"written": true}
 *     time SECONDS      the clock shows so much since the start: {"time": true}
 *     go                one cycle: {"files": {NAME: TEXT, ...}, "read": [NAME, ...], "published": [NAME, ...],
 *                       "marking": {PLACE: [[count, value], ...], ...}, "fired": N, "ended": null | "finished" |
 *                       "stopped"}; "read" and "published" have files in the order in which they were read and
 *                       replaced; of a program that has ended, the state before is back then
 *
 * At the start the tables of the program (pn_cell, and what pn_net says of places and transitions) are told, then the
 * first cycle is done, and its answer is given unasked.
 */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pn/pn_port.h"
#include "pn/pn_text.h"
#include "conform_tables.h"
#include "../supervisor/supervisor_impl.h"

#define FILES_MAX   512U
#define FILE_SIZE   (PN_CHANNEL_TEXT + 104U) /* no message is as long */
#define NAME_SIZE   256U
#define LINE_SIZE   (2U * (FILE_SIZE + NAME_SIZE) + 32U)
#define ANSWER_SIZE ((size_t)1U << 24U)

enum { DIRECTORY = 1000, FIRST_FILE = 2000 }; /* descriptors: numbers that no real one has */

typedef struct memory_file {
    bool exists;
    char name[NAME_SIZE];
    size_t length;
    char data[FILE_SIZE];
} memory_file_t;

static memory_file_t s_file[FILES_MAX];
#define BEGIN_NS UINT64_C(1000000000) /* any beginning will do */
static uint64_t s_now_ns = BEGIN_NS;
static const sup_t *s_sup; /* the program under test */
static uint64_t s_fired_before;
static char s_answer[ANSWER_SIZE];

/* Names of files in the order in which something was done with them, since the last answer. */
typedef struct names {
    uint32_t count;
    char name[FILES_MAX][NAME_SIZE];
} names_t;

static names_t s_published;
static names_t s_read;

/* --- files -------------------------------------------------------------------------------------------------------- */

static memory_file_t *find(const char *name)
{
    for (uint32_t i = 0U; i < FILES_MAX; i++) {
        if (s_file[i].exists && (strcmp(s_file[i].name, name) == 0)) {
            return &s_file[i];
        }
    }
    return NULL;
}

static memory_file_t *make(const char *name)
{
    memory_file_t *file = find(name);
    for (uint32_t i = 0U; (file == NULL) && (i < FILES_MAX); i++) {
        if (!s_file[i].exists) {
            file = &s_file[i];
            file->exists = true;
            file->length = 0U;
            (void)snprintf(file->name, sizeof file->name, "%s", name);
        }
    }
    return file;
}

static int put(memory_file_t *file, const char *data, size_t length)
{
    if ((file == NULL) || (length > FILE_SIZE)) {
        return ENOSPC;
    }
    if (length > 0U) {
        (void)memcpy(file->data, data, length);
    }
    file->length = length;
    return 0;
}

static void note(names_t *names, const char *name)
{
    if (names->count < FILES_MAX) {
        (void)snprintf(names->name[names->count], NAME_SIZE, "%s", name);
        names->count++;
    }
}

/* Appends "member": [NAME, ...], and forgets them. */
static void tell(pn_text_t *text, const char *member, names_t *names)
{
    pn_text_str(text, member);
    pn_text_str(text, ": [");
    for (uint32_t i = 0U; i < names->count; i++) {
        pn_text_str(text, (i > 0U) ? ", " : "");
        pn_text_json_str(text, names->name[i]);
    }
    pn_text_str(text, "], ");
    names->count = 0U;
}

/* Replaces a file by a whole one. */
static int publish(const char *name, const char *data, size_t length)
{
    note(&s_published, name);
    return put(make(name), data, length);
}

int pn_port_dir_open(const char *path, bool create, int *directory)
{
    (void)path;
    (void)create;
    *directory = DIRECTORY;
    return 0;
}

bool pn_port_dir_exists(int directory)
{
    return directory == DIRECTORY;
}

void pn_port_close(int descriptor)
{
    (void)descriptor;
}

int pn_port_load(const char *path, char *buffer, size_t capacity, size_t *length)
{
    *length = 0U;
    errno = 0;
    FILE *const file = fopen(path, "rb"); /* input files are real ones */
    if (file == NULL) {
        return errno;
    }
    *length = fread(buffer, 1U, capacity, file);
    const int error = (ferror(file) != 0) ? errno : 0;
    (void)fclose(file);
    return error;
}

int pn_port_read(int directory, const char *name, char *buffer, size_t capacity, size_t *length, int *held)
{
    const memory_file_t *const file = find(name);
    (void)directory;
    note(&s_read, name);
    if (held != NULL) {
        *held = -1;
    }
    if (file == NULL) {
        return ENOENT;
    }
    *length = (file->length < capacity) ? file->length : capacity;
    (void)memcpy(buffer, file->data, *length);
    return 0;
}

int pn_port_publish(int directory, const char *name, const char *temporary, const char *data, size_t length)
{
    (void)directory;
    (void)temporary;
    return publish(name, data, length);
}

int pn_port_prepare(int directory, const char *temporary, const char *data, size_t length, int *file)
{
    memory_file_t *const made = make(temporary);
    (void)directory;
    const int error = put(made, data, length);
    if (error == 0) {
        *file = FIRST_FILE + (int)(made - s_file);
    }
    return error;
}

int pn_port_publish_prepared(int directory, const char *name, const char *temporary, int file, const char *data,
                             size_t length)
{
    memory_file_t *const made = &s_file[file - FIRST_FILE];
    (void)directory;
    (void)temporary;
    if ((made->length + length) > FILE_SIZE) {
        return ENOSPC;
    }
    (void)memcpy(&made->data[made->length], data, length);
    made->length += length;
    const int error = publish(name, made->data, made->length);
    made->exists = false;
    return error;
}

void pn_port_remove(int directory, const char *name)
{
    memory_file_t *const file = find(name);
    (void)directory;
    if (file != NULL) {
        file->exists = false;
    }
}

int pn_port_lock(int directory, const char *name, int *file)
{
    memory_file_t *const made = make(name);
    (void)directory;
    if (made == NULL) {
        return ENOSPC;
    }
    made->length = 0U; /* it is empty before it is locked */
    *file = FIRST_FILE + (int)(made - s_file);
    return 0;
}

int pn_port_rewrite(int file, const char *data, size_t length)
{
    return put(&s_file[file - FIRST_FILE], data, length);
}

int pn_port_probe(int directory, const char *name, bool *exists, bool *locked)
{
    (void)directory;
    *exists = find(name) != NULL;
    *locked = false; /* no other party is a process here */
    return 0;
}

int pn_port_watch(const char *path, int *watch)
{
    (void)path;
    *watch = -1; /* so the program looks at all files in each cycle */
    return 0;
}

bool pn_port_changes(int watch, pn_port_change_t change, void *user)
{
    (void)watch;
    change(user, NULL);
    return true;
}

/* --- time and signals --------------------------------------------------------------------------------------------- */

uint64_t pn_port_now(void)
{
    return s_now_ns;
}

uint32_t pn_port_unique(void)
{
    return 1U;
}

uint64_t pn_port_pid(void)
{
    return 1U;
}

int pn_port_signals(void)
{
    return 0;
}

int pn_port_stop_signal(void)
{
    return 0;
}

long pn_port_receive(int descriptor, char *buffer, size_t capacity)
{
    (void)descriptor;
    (void)buffer;
    (void)capacity;
    return 0;
}

/* --- the conversation --------------------------------------------------------------------------------------------- */

static void say(const char *line)
{
    (void)fputs(line, stdout);
    (void)fputc('\n', stdout);
    (void)fflush(stdout);
}

/* What the last cycle has left: all files but the temporary ones, the marking of the places that are the program's. */
static void answer(const char *ended)
{
    pn_text_t text;
    const char *between = "";
    pn_text_init(&text, s_answer, sizeof s_answer);
    pn_text_str(&text, "{\"files\": {");
    for (uint32_t i = 0U; i < FILES_MAX; i++) {
        if (s_file[i].exists && (s_file[i].name[0] != '.')) {
            pn_text_str(&text, between);
            pn_text_json_str(&text, s_file[i].name);
            pn_text_str(&text, ": ");
            pn_text_json_bytes(&text, s_file[i].data, s_file[i].length);
            between = ", ";
        }
    }
    pn_text_str(&text, "}, ");
    tell(&text, "\"read\"", &s_read);
    tell(&text, "\"published\"", &s_published);
    pn_text_str(&text, "\"marking\": {");
    between = "";
    for (uint32_t i = 0U; (s_sup != NULL) && (i < s_sup->net->place_count); i++) {
        const pn_place_t *const place = &s_sup->net->place[i];
        pn_text_str(&text, between);
        pn_text_json_str(&text, place->name);
        pn_text_str(&text, ": ");
        pn_multiset_json(place->multiset, s_sup->marking, &text);
        between = ", ";
    }
    pn_text_str(&text, "}, \"fired\": ");
    pn_text_uint(&text, (s_sup != NULL) ? (s_sup->fired - s_fired_before) : 0U);
    pn_text_str(&text, ", \"ended\": ");
    if (ended == NULL) {
        pn_text_str(&text, "null");
    } else {
        pn_text_json_str(&text, ended);
        pn_text_str(&text, ", \"reason\": ");
        pn_text_json_str(&text, (s_sup != NULL) ? s_sup->reason : "");
    }
    pn_text_str(&text, text.truncated ? "" : "}");
    say(text.truncated ? "{\"error\": \"the marking is too large to be told\"}" : s_answer);
    s_fired_before = (s_sup != NULL) ? s_sup->fired : 0U;
}

static void tables(void)
{
    pn_text_t text;
    pn_text_init(&text, s_answer, sizeof s_answer);
    conform_tables(&text);
    say(text.truncated ? "{\"error\": \"the tables are too large to be told\"}" : s_answer);
}

/* A line of standard input, byte by byte: nothing may be read ahead, as what comes next may be for a copy of this
 * process. */
static bool command(char *line, size_t capacity)
{
    size_t length = 0U;
    char c = '\0';
    while ((read(STDIN_FILENO, &c, 1U) == 1) && (c != '\n')) {
        if ((length + 1U) < capacity) {
            line[length] = c;
            length++;
        }
    }
    line[length] = '\0';
    return c == '\n';
}

/* The copy goes on; this process is the saved state, and answers when the copy has ended. */
static void push(void)
{
    (void)fflush(stdout);
    const pid_t copy = fork();
    if (copy == 0) {
        say("{\"pushed\": true}");
        return;
    }
    if (copy < 0) {
        say("{\"error\": \"the state cannot be saved\"}");
        return;
    }
    int status = 0;
    while ((waitpid(copy, &status, 0) < 0) && (errno == EINTR)) {
        /* again */
    }
    if (WIFSIGNALED(status)) {
        (void)printf("{\"error\": \"the program was ended by signal %d\"}\n", WTERMSIG(status));
        (void)fflush(stdout);
    } else {
        say("{\"popped\": true}");
    }
}

static int digit(char c)
{
    return ((c >= '0') && (c <= '9')) ? (c - '0') : (c - 'a') + 10;
}

/* Bytes in hexadecimal, up to a blank; returns their number. */
static size_t from_hex(const char *hex, char *out, size_t capacity)
{
    size_t length = 0U;
    for (const char *at = hex; (at[0] != '\0') && (at[0] != ' ') && (at[1] != '\0') && (length < capacity); at += 2) {
        out[length] = (char)((digit(at[0]) * 16) + digit(at[1]));
        length++;
    }
    return length;
}

static void write_file(const char *text)
{
    char name[NAME_SIZE] = "";
    char data[FILE_SIZE];
    const char *const space = strchr(text, ' ');
    (void)from_hex(text, name, sizeof name - 1U);
    const size_t length = (space != NULL) ? from_hex(space + 1, data, sizeof data) : 0U;
    say((put(make(name), data, length) == 0) ? "{\"written\": true}"
                                             : "{\"error\": \"there is no room for the file\"}");
}

/* The program waits: here it is asked. Back when it is to go on. */
bool pn_port_wait(int descriptor, uint64_t timeout_ns)
{
    static char s_line[LINE_SIZE];
    (void)timeout_ns;
    answer(NULL);
    for (;;) {
        if (!command(s_line, sizeof s_line) || (strcmp(s_line, "pop") == 0)) {
            _exit(EXIT_SUCCESS);
        }
        if (strcmp(s_line, "push") == 0) {
            push();
        } else if (strncmp(s_line, "write ", 6U) == 0) {
            write_file(&s_line[6]);
        } else if (strncmp(s_line, "time ", 5U) == 0) {
            s_now_ns = BEGIN_NS + (uint64_t)((strtod(&s_line[5], NULL) * 1e9) + 0.5);
            say("{\"time\": true}");
        } else if (strcmp(s_line, "go") == 0) {
            return descriptor >= 0;
        } else {
            say("{\"error\": \"unknown command\"}");
        }
    }
}

/* The linker puts this in front of the host's own (--wrap): here the program under test becomes known, and its end is
 * told. */
void __real_sup_run_cell(sup_t *sup);
void __wrap_sup_run_cell(sup_t *sup);
void __wrap_sup_run_cell(sup_t *sup)
{
    tables();
    s_sup = sup;
    __real_sup_run_cell(sup);
    answer(sup->stopped ? "stopped" : "finished");
    (void)fflush(stdout);
    _exit(EXIT_SUCCESS);
}
