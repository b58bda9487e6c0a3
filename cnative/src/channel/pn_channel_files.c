/* SPDX-License-Identifier: MIT
 * pn_channel_files.c - the transport of shared files. I1..I10 are the invariants of docs/protocol.md.
 *
 * Making a file costs as much as all the rest of an answer (measured on tmpfs: create 3 us, write 2, rename 4). So the
 * temporary files of the next messages are made while there is nothing to do (`prepare`), and an answer only writes and
 * renames. The same holds for the look whether an outgoing file is empty (I3): it is done when the notice comes that
 * its reader has emptied it.
 */
#include "pn/pn_channel.h"
#include "pn/pn_port.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define NAME_SIZE 256U

static const char EMPTY[] =
    "0\n"; /* the content of a channel without a message; all that is ever written to an incoming one */

static const uint64_t NS_PER_MS = 1000000U;
enum { STALE_PEER_WAITS = 100 }; /* of 10 ms: a robot of an earlier run notices within 100 ms that we are new */

typedef struct file_channel {
    bool dirty;        /* may have changed since the last look */
    bool accepted;     /* in: the file's message is a token and has not been cleared yet */
    bool sealed;       /* in: the accepted (or last read) message had a seq */
    uint32_t content;  /* in: CRC of the whole file at the last look */
    uint64_t last_seq; /* in: of the message read last */
    uint64_t seq;      /* in: last one consumed; out: last one written */
    bool empty;        /* out: seen empty, and nothing has been written there since */
    int prepared;      /* the temporary file, made and opened beforehand; -1: none */
    int spent;         /* the descriptor of the last publication, to be closed at leisure; -1: none */
    int held;          /* of the file that the next publication replaces; -1: none */
    uint32_t own;      /* in: notices of our own clearing that are still to come */
    char temporary[NAME_SIZE];
} file_channel_t;

static struct {
    const pn_cell_t *cell;
    pn_files_options_t options;
    int directory;
    int status; /* our own status file, locked */
    int watch;  /* -1: look every time */
    char session[PN_CHANNEL_SESSION];
    char buffer[PN_CHANNEL_TEXT];
    pn_transport_fault_t fault;
    file_channel_t channel[PN_CELL_CHANNELS_MAX];
} s_files;

const char *pn_files_session(void)
{
    return s_files.session;
}

__attribute__((format(printf, 2, 3))) static bool fail(bool io, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    s_files.fault.io = io;
    (void)vsnprintf(s_files.fault.text, sizeof s_files.fault.text, format, arguments);
    va_end(arguments);
    return false;
}

/* Errors of what is no file: a link, a pipe that nobody reads, a folder, a pipe. As bits: they are small numbers. */
static const uint64_t NO_FILE =
    (1ULL << (uint32_t)ELOOP) | (1ULL << (uint32_t)ENXIO) | (1ULL << (uint32_t)EISDIR) | (1ULL << (uint32_t)EINVAL);

/* A failed call on a file of the directory: says whether it is the whole directory. */
static bool fail_errno(const char *doing, const char *name, int error)
{
    if ((error == ENOENT) && !pn_port_dir_exists(s_files.directory)) {
        return fail(true, "the shared directory %s has been removed", s_files.options.directory);
    }
    const char *advice = "";
    if ((error == ENOSPC) || (error == EFBIG) || (error == EDQUOT)) {
        advice = "; make room there, or choose another directory with --dir";
    } else if ((error == EROFS) || (error == EACCES) || (error == EPERM)) {
        advice = "; choose a directory that can be written with --dir";
    } else if (((NO_FILE >> ((uint32_t)error & 63U)) & 1U) != 0U) {
        advice = "; it is a link, a pipe, a folder or the like, not a file";
    } else {
        /* the system's words say it */
    }
    return fail(true, "cannot %s %s/%s: %s%s", doing, s_files.options.directory, name, strerror(error), advice);
}

/* --- channels ----------------------------------------------------------------------------------------------------- */

static pn_channel_state_t files_read(void *self, uint32_t index, pn_message_t *out)
{
    (void)self;
    file_channel_t *const state = &s_files.channel[index];
    const pn_cell_channel_t *const channel = &s_files.cell->channel[index];
    if ((s_files.watch >= 0) && !state->dirty) {
        return PN_CHANNEL_UNCHANGED;
    }
    state->dirty = false;
    size_t length = 0U;
    pn_port_close(state->held);
    const int error =
        pn_port_read(s_files.directory, channel->file, s_files.buffer, sizeof s_files.buffer, &length, &state->held);
    if (error == ENOENT) {
        if (!pn_port_dir_exists(s_files.directory)) {
            (void)fail_errno("read", channel->file, error);
            return PN_CHANNEL_BROKEN;
        }
        out->refusal = PN_REFUSAL_MISSING;
        out->column = 0U;
        (void)snprintf(out->report, sizeof out->report,
                       "the file is missing; an empty channel is a file that holds `0`");
        state->content = 0U;
        state->dirty = true; /* look again: the directory itself may be going */
        return PN_CHANNEL_REFUSED;
    }
    if (error != 0) {
        (void)fail_errno("read", channel->file, error);
        return PN_CHANNEL_BROKEN;
    }
    const uint32_t content = pn_crc32(0U, s_files.buffer, length);
    if (state->accepted) {
        if (content == state->content) {
            return PN_CHANNEL_UNCHANGED; /* still waiting to be consumed */
        }
        char shown[160];
        out->refusal = PN_REFUSAL_OVERWRITTEN;
        out->column = 0U;
        (void)snprintf(out->report, sizeof out->report,
                       "changed to %s before the message in it was consumed (channel-overrun)",
                       pn_quote(s_files.buffer, length, shown, sizeof shown));
        return PN_CHANNEL_REFUSED;
    }
    state->content = content;
    const pn_channel_state_t found =
        pn_channel_parse(channel, s_files.buffer, length, s_files.session, state->seq, out);
    state->sealed = out->sealed;
    state->last_seq = out->seq;
    return found;
}

static void files_accept(void *self, uint32_t index)
{
    (void)self;
    s_files.channel[index].accepted = true;
}

/* The name of the temporary file of this side beside a channel's. */
static bool name_temporary(const char *file, char temporary[NAME_SIZE])
{
    const int length = snprintf(temporary, NAME_SIZE, ".%s.%s.tmp", file, s_files.cell->side);
    if (((size_t)length >= NAME_SIZE) || (strchr(file, '/') != NULL)) { /* a negative length is a large one here */
        return fail(true, "`%s` cannot be the name of a channel's file", file);
    }
    return true;
}

/* Makes the file of a channel between two peers, empty. */
static bool make_empty(const char *file)
{
    char temporary[NAME_SIZE];
    if (!name_temporary(file, temporary)) {
        return false;
    }
    const int error = pn_port_publish(s_files.directory, file, temporary, EMPTY, sizeof EMPTY - 1U);
    if (error != 0) {
        return fail_errno("write", file, error);
    }
    return true;
}

/* Publishes a content, by the prepared file where there is one (I2). */
static bool put_file(uint32_t index, const char *data, size_t length)
{
    const char *const file = s_files.cell->channel[index].file;
    file_channel_t *const state = &s_files.channel[index];
    int error;
    if (state->prepared >= 0) {
        const size_t left =
            (s_files.cell->channel[index].direction == PN_CHANNEL_IN) ? 0U : length; /* it holds EMPTY */
        error = pn_port_publish_prepared(s_files.directory, file, state->temporary, state->prepared, data, left);
        state->spent = state->prepared;
        state->prepared = -1;
    } else {
        error = pn_port_publish(s_files.directory, file, state->temporary, data, length);
    }
    if (error != 0) {
        return fail_errno("write", file, error);
    }
    return true;
}

/* Makes ready for the next publications. What fails here is tried, and reported, when there is something to publish. */
static void prepare(void)
{
    for (uint32_t i = 0U; i < s_files.cell->channel_count; i++) {
        file_channel_t *const state = &s_files.channel[i];
        if (state->spent >= 0) { /* something was published: what it replaced can go now */
            pn_port_close(state->spent);
            pn_port_close(state->held);
            state->spent = -1;
            state->held = -1;
        }
        const size_t length = (s_files.cell->channel[i].direction == PN_CHANNEL_IN) ? sizeof EMPTY - 1U : 0U;
        if ((state->prepared < 0)
            && (pn_port_prepare(s_files.directory, state->temporary, EMPTY, length, &state->prepared) != 0)) {
            state->prepared = -1;
        }
    }
}

static void unprepare(void)
{
    for (uint32_t i = 0U; (s_files.directory >= 0) && (i < s_files.cell->channel_count); i++) {
        file_channel_t *const state = &s_files.channel[i];
        pn_port_close(state->spent);
        pn_port_close(state->held);
        state->spent = -1;
        state->held = -1;
        if (state->prepared >= 0) {
            pn_port_close(state->prepared);
            state->prepared = -1;
            pn_port_remove(s_files.directory, state->temporary);
        }
    }
}

static bool files_clear(void *self, uint32_t index) /* I4 */
{
    (void)self;
    file_channel_t *const state = &s_files.channel[index];
    if (!put_file(index, EMPTY, sizeof EMPTY - 1U)) {
        return false;
    }
    state->own += (s_files.watch >= 0) ? 1U : 0U;
    state->accepted = false;
    if (state->sealed) {
        state->seq = state->last_seq;
    }
    return true;
}

/* Whether the file holds `0`; on an I/O error or a missing file false with the fault set. */
static bool holds_nothing(uint32_t index, bool *empty)
{
    const pn_cell_channel_t *const channel = &s_files.cell->channel[index];
    size_t length = 0U;
    *empty = false;
    pn_port_close(s_files.channel[index].held);
    const int error = pn_port_read(s_files.directory, channel->file, s_files.buffer, sizeof s_files.buffer, &length,
                                   &s_files.channel[index].held);
    if (error != 0) {
        return fail_errno("read", channel->file, error);
    }
    *empty = pn_channel_is_empty(s_files.buffer, length);
    s_files.buffer[(length < sizeof s_files.buffer) ? length : sizeof s_files.buffer - 1U] = '\0';
    return true;
}

static bool files_write(void *self, uint32_t index, const pn_scalar_value_t *scalar_value)
{
    (void)self;
    static char text[PN_CHANNEL_TEXT];
    file_channel_t *const state = &s_files.channel[index];
    const pn_cell_channel_t *const channel = &s_files.cell->channel[index];
    bool empty = state->empty && !state->dirty; /* which it always is without notices */
    if (!empty && !holds_nothing(index, &empty)) {
        return false;
    }
    if (!empty) { /* I3 */
        char shown[160];
        return fail(false,
                    "channel-overrun: %s still holds %s, which %s has not taken; the next message cannot be written",
                    channel->file, pn_quote(s_files.buffer, strlen(s_files.buffer), shown, sizeof shown),
                    s_files.cell->peer[channel->peer].name);
    }
    const size_t length =
        pn_channel_compose(channel, scalar_value, state->seq + 1U, s_files.session, text, sizeof text);
    if (length == 0U) {
        return fail(false,
                    "the token of place `%s` cannot be written to %s: a value is not finite or out of its range, or "
                    "the message has "
                    "more than %u bytes",
                    channel->place_name, channel->file, PN_CHANNEL_PAYLOAD);
    }
    if (!put_file(index, text, length)) {
        return false;
    }
    state->empty = false;
    state->seq++;
    return true;
}

/* --- liveness and status (I8, I9) --------------------------------------------------------------------------------- */

static const char *const STATE_NAME[] = { "absent", "running", "finished", "stopped", "dead" };

static void status_name(const char *side, char *out, size_t capacity)
{
    (void)snprintf(out, capacity, "%s.status", side);
}

/* The next line of a text as a string; returns what follows it. */
static const char *take_line(const char *text, char *out, size_t capacity)
{
    size_t n = 0U;
    size_t i = 0U;
    while ((text[i] != '\0') && (text[i] != '\n')) {
        if (n + 1U < capacity) {
            out[n++] = text[i];
        }
        i++;
    }
    out[n] = '\0';
    return (text[i] == '\n') ? text + i + 1U : text + i;
}

typedef struct status {
    pn_party_state_t state; /* ABSENT when the file cannot be understood */
    char session[PN_CHANNEL_SESSION];
    uint64_t pid;
    char reason[256];
} status_t;

static void status_read(const char *side, status_t *out)
{
    char name[NAME_SIZE];
    char text[512];
    char first[32];
    char second[64];
    size_t length = 0U;
    (void)memset(out, 0, sizeof *out);
    status_name(side, name, sizeof name);
    if (pn_port_read(s_files.directory, name, text, sizeof text - 1U, &length, NULL) != 0) {
        return;
    }
    text[length] = '\0';
    const char *rest = take_line(text, first, sizeof first);
    rest = take_line(rest, second, sizeof second);
    (void)take_line(rest, out->reason, sizeof out->reason);
    if (sscanf(second, "%15s %" SCNu64, out->session, &out->pid) == 2) {
        for (uint32_t i = (uint32_t)PN_PARTY_RUNNING; i <= (uint32_t)PN_PARTY_STOPPED; i++) {
            if (strcmp(first, STATE_NAME[i]) == 0) {
                out->state = (pn_party_state_t)i;
            }
        }
    }
}

static void files_party(void *self, uint32_t peer, pn_party_t *out)
{
    (void)self;
    const char *const side = s_files.cell->peer[peer].name;
    char name[NAME_SIZE];
    status_t status;
    bool exists = false;
    bool locked = false;
    status_name(side, name, sizeof name);
    /* The lock first: who gives it up has said why before, so a status read after that is the last word. */
    const int error = pn_port_probe(s_files.directory, name, &exists, &locked);
    status_read(side, &status);
    const bool announced =
        exists && (error == 0) && (status.state != PN_PARTY_ABSENT) && (strcmp(status.session, s_files.session) == 0);
    out->state = announced ? status.state : PN_PARTY_ABSENT;
    out->pid = status.pid;
    if (announced && !locked && (status.state == PN_PARTY_RUNNING)) {
        out->state = PN_PARTY_DEAD;
    }
    (void)snprintf(out->reason, sizeof out->reason, "%s", status.reason);
}

static bool files_announce(void *self, pn_party_state_t state, const char *reason)
{
    (void)self;
    char text[512];
    char line[256];
    (void)take_line(reason, line, sizeof line); /* one line, whatever it was */
    const int length = snprintf(text, sizeof text, "%s\n%s %" PRIu64 "\n%s\n", STATE_NAME[state], s_files.session,
                                pn_port_pid(), line);
    const int error = pn_port_rewrite(s_files.status, text, (length > 0) ? (size_t)length : 0U);
    if (error != 0) {
        char name[NAME_SIZE];
        status_name(s_files.cell->side, name, sizeof name);
        return fail_errno("write", name, error);
    }
    return true;
}

/* --- waiting ------------------------------------------------------------------------------------------------------ */

typedef struct change {
    bool incoming;
} change_t;

static void on_change(void *user, const char *name)
{
    change_t *const change = user;
    if ((name != NULL) && (name[0] == '.')) {
        return; /* a temporary file on its way */
    }
    for (uint32_t i = 0U; i < s_files.cell->channel_count; i++) {
        file_channel_t *const state = &s_files.channel[i];
        if (name == NULL) {
            state->dirty = true;
            state->own = 0U;
        } else if (strcmp(name, s_files.cell->channel[i].file) == 0) {
            const bool ours = (state->own > 0U);
            state->own -= ours ? 1U : 0U;
            state->dirty = state->dirty || !ours;
            change->incoming = change->incoming || (!ours && (s_files.cell->channel[i].direction == PN_CHANNEL_IN));
        } else {
            /* another channel's file, or a status */
        }
    }
}

/* Outgoing files that changed: has their reader emptied them? */
static void look_at_outgoing(void)
{
    for (uint32_t i = 0U; i < s_files.cell->channel_count; i++) {
        file_channel_t *const state = &s_files.channel[i];
        if ((s_files.cell->channel[i].direction == PN_CHANNEL_OUT) && state->dirty) {
            state->dirty = false;
            if (!holds_nothing(i, &state->empty)) {
                state->empty = false; /* reported when there is something to write */
            }
        }
    }
}

static pn_wait_t files_wait(void *self, uint64_t timeout_ns)
{
    (void)self;
    const uint64_t begin = pn_port_now();
    change_t change = { false };
    uint64_t spent = 0U;
    bool over = false;
    if (s_files.watch < 0) {
        prepare();
        (void)pn_port_wait(-1, (timeout_ns < s_files.options.poll_ns) ? timeout_ns : s_files.options.poll_ns);
        return (pn_port_stop_signal() != 0) ? PN_WAIT_SIGNAL : PN_WAIT_CHANGED;
    }
    /* Only what another party wrote into an incoming channel is worth a cycle; the rest is taken note of. */
    while (!change.incoming && !over && (pn_port_stop_signal() == 0)) {
        if (!pn_port_changes(s_files.watch, on_change, &change)) {
            on_change(&change, NULL); /* the directory is gone: let the next read say so */
            change.incoming = true;
        }
        if (!change.incoming) {
            look_at_outgoing();
            prepare();
            (void)pn_port_wait(s_files.watch, timeout_ns - spent);
            spent = pn_port_now() - begin;
            over = (spent >= timeout_ns);
        }
    }
    if (pn_port_stop_signal() != 0) {
        return PN_WAIT_SIGNAL;
    }
    if (!change.incoming) {
        on_change(&change, NULL); /* nothing happened for a while: look for once all the same */
        return PN_WAIT_TIMEOUT;
    }
    return PN_WAIT_CHANGED;
}

static void files_close(void *self)
{
    (void)self;
    unprepare();
    pn_port_close(s_files.watch);
    pn_port_close(s_files.status); /* and with it the lock */
    pn_port_close(s_files.directory);
    s_files.watch = -1;
    s_files.status = -1;
    s_files.directory = -1;
}

/* --- opening (I7) ------------------------------------------------------------------------------------------------- */

static bool take_lock(void)
{
    char name[NAME_SIZE];
    status_t other;
    status_name(s_files.cell->side, name, sizeof name);
    int error = pn_port_lock(s_files.directory, name, &s_files.status);
    for (uint32_t i = 0U; (i < 20U) && (error == EWOULDBLOCK); i++) { /* somebody may just be probing it */
        (void)pn_port_wait(-1, 5U * NS_PER_MS);
        error = pn_port_lock(s_files.directory, name, &s_files.status);
    }
    if (error == EWOULDBLOCK) {
        status_read(s_files.cell->side, &other);
        return fail(true,
                    "another %s (pid %" PRIu64 ") is running in %s; stop it, or choose another directory with --dir",
                    s_files.cell->side, other.pid, s_files.options.directory);
    }
    if (error != 0) {
        return fail_errno("write", name, error);
    }
    return true; /* it is empty now: an old `running` is not taken for ours */
}

/* Robots of an earlier run have to be gone: they might act on what we write. */
static bool await_stale_peers(void)
{
    uint32_t waits = 0U; /* the clock goes on where a busy machine lets neither us nor the robot run */
    for (uint32_t i = 0U; i < s_files.cell->peer_count; i++) {
        char name[NAME_SIZE];
        bool exists = false;
        bool locked = false;
        status_name(s_files.cell->peer[i].name, name, sizeof name);
        int error = pn_port_probe(s_files.directory, name, &exists, &locked);
        while (locked && (waits < (uint32_t)STALE_PEER_WAITS) && (pn_port_stop_signal() == 0)) {
            waits++;
            (void)pn_port_wait(-1, 10U * NS_PER_MS);
            error = pn_port_probe(s_files.directory, name, &exists, &locked);
        }
        if (error != 0) {
            return fail_errno("read", name, error);
        }
        if (locked) {
            status_t status;
            status_read(s_files.cell->peer[i].name, &status);
            return fail(true, "%s (pid %" PRIu64 ") of an earlier run is still alive in %s; stop it first",
                        s_files.cell->peer[i].name, status.pid, s_files.options.directory);
        }
        pn_port_remove(s_files.directory, name);
    }
    return true;
}

static bool clean_channels(void)
{
    for (uint32_t i = 0U; i < s_files.cell->channel_count; i++) {
        const pn_cell_channel_t *const channel = &s_files.cell->channel[i];
        char text[PN_CHANNEL_REPORT];
        char name[NAME_SIZE];
        char shown[160];
        size_t length = 0U;
        const int error =
            pn_port_read(s_files.directory, channel->file, s_files.buffer, sizeof s_files.buffer, &length, NULL);
        const bool empty = (error == ENOENT) || ((error == 0) && pn_channel_is_empty(s_files.buffer, length));
        if ((error != 0) && (error != ENOENT)) {
            return fail_errno("read", channel->file, error);
        }
        if (!empty) {
            (void)snprintf(text, sizeof text, "%s held %s, left by an earlier run: discarded", channel->file,
                           pn_quote(s_files.buffer, length, shown, sizeof shown));
            s_files.options.notice(s_files.options.user, text);
        }
        (void)snprintf(name, sizeof name, ".%s.%s.tmp", channel->file, s_files.cell->peer[channel->peer].name);
        pn_port_remove(s_files.directory, name);
        if (!put_file(i, EMPTY, sizeof EMPTY - 1U)) {
            return false;
        }
        s_files.channel[i].empty = true;
    }
    bool is_fine = true;
    for (uint32_t i = 0U; is_fine && (i < s_files.cell->between_count); i++) {
        is_fine = make_empty(s_files.cell->between[i]);
    }
    return is_fine;
}

static bool open_all(void)
{
    int error = pn_port_dir_open(s_files.options.directory, s_files.options.create, &s_files.directory);
    if (error == ENOENT) {
        return fail(true, "the shared directory %s cannot be made: the folder that should hold it does not exist",
                    s_files.options.directory);
    }
    if (error != 0) {
        return fail(true, "cannot open the shared directory %s: %s", s_files.options.directory, strerror(error));
    }
    if (!take_lock() || !await_stale_peers()) {
        return false;
    }
    if (s_files.options.watch) {
        error = pn_port_watch(s_files.options.directory, &s_files.watch);
        if (error != 0) {
            (void)snprintf(s_files.buffer, sizeof s_files.buffer,
                           "no notifications of changes in %s (%s): polling every %" PRIu64 " ms",
                           s_files.options.directory, strerror(error), s_files.options.poll_ns / NS_PER_MS);
            s_files.options.notice(s_files.options.user, s_files.buffer);
        }
    }
    return clean_channels() && files_announce(NULL, PN_PARTY_RUNNING, "");
}

bool pn_files_open(const pn_cell_t *cell, const pn_files_options_t *options, pn_transport_t *out)
{
    (void)memset(&s_files, 0, sizeof s_files);
    s_files.cell = cell;
    s_files.options = *options;
    s_files.directory = -1;
    s_files.status = -1;
    s_files.watch = -1;
    out->name = "files";
    out->self = NULL;
    out->fault = &s_files.fault;
    out->read = files_read;
    out->accept = files_accept;
    out->clear = files_clear;
    out->write = files_write;
    out->party = files_party;
    out->announce = files_announce;
    out->wait = files_wait;
    out->close = files_close;
    (void)snprintf(s_files.session, sizeof s_files.session, "%08" PRIx32, pn_port_unique());
    for (uint32_t i = 0U; i < cell->channel_count; i++) {
        if (!name_temporary(cell->channel[i].file, s_files.channel[i].temporary)) {
            return false;
        }
        s_files.channel[i].dirty = true;
        s_files.channel[i].prepared = -1;
        s_files.channel[i].spent = -1;
        s_files.channel[i].held = -1;
    }
    if (!open_all()) {
        files_close(NULL);
        return false;
    }
    return true;
}
