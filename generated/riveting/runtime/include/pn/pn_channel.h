/* SPDX-License-Identifier: MIT
 * pn_channel.h - channels: places of the net that two parties share, seen from the host of one of them.
 *
 * Two things live here: the text form of a message (pn_channel.c, used for input files too), and the interface behind
 * which a transport carries messages (pn_channel_files.c: the shared files of docs/protocol.md). A transport moves
 * messages and keeps the invariants I1..I10 on its side; it knows nothing of nets. What a message means is the host's
 * business.
 */
#ifndef PN_CHANNEL_H
#define PN_CHANNEL_H

#include "pn/pn_cell.h"
#include "pn/pn_net.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Most scalars of a message or of an input file. The Makefile of a cell whose colour sets hold more says so. */
#ifndef PN_CHANNEL_SCALARS
#define PN_CHANNEL_SCALARS 64U
#endif
#define PN_CHANNEL_TEXT    (64U * PN_CHANNEL_SCALARS) /* more bytes than a channel's file may have */
#define PN_CHANNEL_PAYLOAD (PN_CHANNEL_TEXT - 41U)    /* of line 1 at most: line 2 fits behind it */
#define PN_CHANNEL_SESSION 16U                        /* bytes of a session's name, terminator included */
#define PN_CHANNEL_REPORT  512U                       /* bytes of a report */

/* Why a message is not taken (I6). */
typedef enum pn_refusal {
    PN_REFUSAL_NONE = 0,
    PN_REFUSAL_MISSING, /* there is no file */
    PN_REFUSAL_SHAPE,   /* empty file, too long, too many lines, stray bytes */
    PN_REFUSAL_COUNT,   /* wrong number of scalars */
    PN_REFUSAL_SCALAR,  /* a scalar is not what it should be: not a number, not finite, out of range, unknown name */
    PN_REFUSAL_COLOUR,  /* the scalars are fine one by one, but the value is not in the colour set */
    PN_REFUSAL_TRAILER, /* line 2 is not `# seq session crc` */
    PN_REFUSAL_CHECKSUM,
    PN_REFUSAL_SESSION,    /* of another run */
    PN_REFUSAL_REPEATED,   /* a message that was consumed already */
    PN_REFUSAL_LOST,       /* a message before this one never arrived */
    PN_REFUSAL_OVERWRITTEN /* the file changed between taking a message and emptying the file */
} pn_refusal_t;

/* What a file holds. */
typedef enum pn_channel_state {
    PN_CHANNEL_UNCHANGED, /* the same as at the last look */
    PN_CHANNEL_EMPTY,
    PN_CHANNEL_MESSAGE,
    PN_CHANNEL_REFUSED,
    PN_CHANNEL_BROKEN /* the transport failed: see its fault */
} pn_channel_state_t;

typedef struct pn_message {
    uint32_t count;
    pn_scalar_value_t value[PN_CHANNEL_SCALARS];
    uint32_t column_of[PN_CHANNEL_SCALARS]; /* where in its line each of them begins, 1-based */
    bool sealed;                            /* it has the line `# seq session crc` */
    uint64_t seq;
    pn_refusal_t refusal;
    uint32_t column;                /* of what was refused, 1-based; 0: the whole */
    char report[PN_CHANNEL_REPORT]; /* what was found and what was expected */
    size_t text_length;
    char text[PN_CHANNEL_TEXT]; /* decoded strings, to which scalars point */
} pn_message_t;

/* --- text form ---------------------------------------------------------------------------------------------------- */

/* Writes a real: four decimals where that reads back to the same number, otherwise the fewest digits that do. Returns
 * the length (without the terminator), 0 when it does not fit. */
size_t pn_real_format(double value, char *out, size_t capacity);

/* Goes along the scalars of a token: those of a list's elements come as often as it is long. Begin with
 * { scalar, scalar_count, 0U, 0U, 0U, 0U }. */
typedef struct pn_scalar_walk {
    const pn_scalar_t *scalar;
    uint32_t count;
    uint32_t next;
    uint32_t first, end; /* of an element of the list that is gone through */
    uint32_t left;       /* of its elements, the one that is gone through included */
} pn_scalar_walk_t;

/* The scalar of the next value; NULL at the end. */
const pn_scalar_t *pn_scalar_next(pn_scalar_walk_t *walk);
/* The value of what it gave last: that of a list says how often its elements come. */
void pn_scalar_is(pn_scalar_walk_t *walk, const pn_scalar_value_t *scalar_value);

/* The scalars separated by one blank. Returns the length; 0 when it does not fit, or when a reader would refuse a
 * scalar: it is not finite, out of its range, no constructor. */
size_t pn_scalars_format(const pn_scalar_t *scalar, uint32_t count, const pn_scalar_value_t *scalar_value, char *out,
                         size_t capacity);

/* Reads `count` scalars from the `length` bytes of one line and appends them to `out` (scalars, decoded strings).
 * On a mistake: false, `out` says which (refusal, column, report). */
PN_NODISCARD bool pn_scalars_parse(const pn_scalar_t *scalar, uint32_t count, const char *line, size_t length,
                                   pn_message_t *out);

/* Whether a file holds no message: `0` on line 1, and no line 2. With a line 2 it is the message 0. */
bool pn_channel_is_empty(const char *text, size_t length);

/* The whole file of a message: payload, and the line `# seq session crc32`. Returns the length; 0 when
 * pn_scalars_format gives nothing or more than PN_CHANNEL_PAYLOAD. */
size_t pn_channel_compose(const pn_cell_channel_t *channel, const pn_scalar_value_t *scalar_value, uint64_t seq,
                          const char *session, char *out, size_t capacity);

/* Reads a file: EMPTY, MESSAGE or REFUSED. `consumed` is the seq of the last message that was consumed, 0 for none. */
pn_channel_state_t pn_channel_parse(const pn_cell_channel_t *channel, const char *text, size_t length,
                                    const char *session, uint64_t consumed, pn_message_t *out);

/* CRC-32 (IEEE 802.3, as zlib's crc32), to be continued from a previous result; begin with 0. */
uint32_t pn_crc32(uint32_t crc, const char *data, size_t length);

/* Printable form of foreign bytes between back-ticks, cut after some 60 of them, or where `capacity`, at least 16, is
 * used up. Returns `out`. */
const char *pn_quote(const char *data, size_t length, char *out, size_t capacity);

/* --- transports --------------------------------------------------------------------------------------------------- */

typedef enum pn_party_state {
    PN_PARTY_ABSENT, /* has not announced itself in this session */
    PN_PARTY_RUNNING,
    PN_PARTY_FINISHED,
    PN_PARTY_STOPPED, /* safely, for `reason` */
    PN_PARTY_DEAD     /* it said `running`, but its process is gone */
} pn_party_state_t;

typedef struct pn_party {
    pn_party_state_t state;
    uint64_t pid;
    char reason[256];
} pn_party_t;

typedef enum pn_wait {
    PN_WAIT_CHANGED, /* an incoming channel may have changed */
    PN_WAIT_TIMEOUT,
    PN_WAIT_SIGNAL /* this program was asked to stop */
} pn_wait_t;

/* A transport's failure: its own fault (a directory that is gone, a full disk) or a broken protocol (an overrun). */
typedef struct pn_transport_fault {
    bool io;
    char text[PN_CHANNEL_REPORT];
} pn_transport_fault_t;

/* Called while a transport opens, for what it had to discard. */
typedef void (*pn_notice_t)(void *user, const char *text);

/* One way of carrying messages. Functions that return false, or BROKEN, have filled `fault`. Not thread-safe. */
typedef struct pn_transport {
    const char *name;
    void *self;
    pn_transport_fault_t *fault;
    /* What the incoming channel holds. After MESSAGE the host puts the token and calls `accept`, or leaves it. */
    pn_channel_state_t (*read)(void *self, uint32_t channel, pn_message_t *out);
    /* The message that `read` gave last has become a token. */
    void (*accept)(void *self, uint32_t channel);
    /* The token has been consumed: empties the channel (I4). */
    PN_NODISCARD bool (*clear)(void *self, uint32_t channel);
    /* Publishes a message on an outgoing channel; a fault when the one before has not been taken (I3). */
    PN_NODISCARD bool (*write)(void *self, uint32_t channel, const pn_scalar_value_t *scalar_value);
    /* What is known of the peer (I8, I9). */
    void (*party)(void *self, uint32_t peer, pn_party_t *out);
    /* Says what has become of this side (I9); "" where there is no reason to give. */
    PN_NODISCARD bool (*announce)(void *self, pn_party_state_t state, const char *reason);
    /* Waits for a change, at most `timeout_ns` (less than UINT64_MAX, which pn_port_wait takes for ever). */
    pn_wait_t (*wait)(void *self, uint64_t timeout_ns);
    void (*close)(void *self);
} pn_transport_t;

typedef struct pn_files_options {
    const char *directory;
    bool create;        /* make the directory when it is missing */
    bool watch;         /* use the system's notices where there are any; false: look every time (lock-step, polling) */
    uint64_t poll_ns;   /* without notices: how often to look */
    pn_notice_t notice; /* not NULL */
    void *user;
} pn_files_options_t;

/* Opens the transport of shared files for the party `cell->side`: takes the lock, discards what an earlier run left
 * (I7), announces `running`. One at a time. On failure: false, `fault` says why, nothing is left behind. */
PN_NODISCARD bool pn_files_open(const pn_cell_t *cell, const pn_files_options_t *options, pn_transport_t *out);

/* The name of the session, for reports; "" before pn_files_open. */
const char *pn_files_session(void);

#ifdef __cplusplus
}
#endif

#endif /* PN_CHANNEL_H */
