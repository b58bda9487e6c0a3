/* SPDX-License-Identifier: MIT
 * pn_cell.h - the generated configuration of a supervisor (cell_config.c): what it exchanges with whom, through which
 * files.
 *
 * net.c says what the net does; pn_cell says which part of it this program plays. A net without a cell has the constant
 * too, with no channels: its supervisor owns every transition.
 */
#ifndef PN_CELL_H
#define PN_CELL_H

#include "pn/pn_net.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PN_CELL_ABI          6U
#define PN_CELL_CHANNELS_MAX 128U
#define PN_CELL_PEERS_MAX    64U

/* One scalar of a token, as it is written in a file. The scalars of the place's tokens (pn_scalar_count) are the same
 * scalars seen from the net; here is what a reader needs besides: names of constructors and ranges. What the elements
 * of a list are made of comes behind it. */
typedef enum pn_scalar_kind {
    PN_SCALAR_UNIT,   /* written 1 */
    PN_SCALAR_BOOL,   /* 0, 1 */
    PN_SCALAR_INT,    /* decimal; `low`..`high` when `bounded` */
    PN_SCALAR_REAL,   /* decimal; `real_low`..`real_high` when `bounded` */
    PN_SCALAR_STRING, /* "in double quotes" */
    PN_SCALAR_ENUM,   /* one of `name` */
    PN_SCALAR_INDEX,  /* decimal, `low`..`high` */
    PN_SCALAR_LIST    /* how many elements, `low`..`high`, and then these */
} pn_scalar_kind_t;

typedef struct pn_scalar {
    pn_scalar_kind_t kind;
    const char *label;  /* "p.x"; for messages */
    const char *colset; /* "COORD"; for messages */
    bool bounded;
    int64_t low, high;
    double real_low, real_high;
    uint32_t name_count;
    const char *const *name;
    uint32_t element_count; /* LIST: of the scalars behind it, those that are repeated; else 0 */
} pn_scalar_t;

typedef enum pn_channel_direction {
    PN_CHANNEL_IN, /* a peer writes, the supervisor reads */
    PN_CHANNEL_OUT /* the supervisor writes, a peer reads */
} pn_channel_direction_t;

typedef enum pn_channel_kind {
    PN_CHANNEL_DATA, /* published before ... */
    PN_CHANNEL_FLAG  /* ... the flags that announce them (I5) */
} pn_channel_kind_t;

typedef struct pn_cell_channel {
    const char *name;       /* "flag1_interno" */
    const char *file;       /* "flag1_interno.robcad" */
    uint32_t place;         /* index in pn_net.place */
    const char *place_name; /* must be that place's name: the two generated files belong together */
    pn_channel_direction_t direction;
    pn_channel_kind_t kind;
    uint32_t peer; /* index in pn_cell_t.peer */
    uint32_t scalar_count;
    const pn_scalar_t *scalar;
} pn_cell_channel_t;

typedef struct pn_cell_input {
    const char *name;
    const char *file; /* in the input directory */
    uint32_t place;
    const char *place_name;
    uint32_t scalar_count;
    const pn_scalar_t *scalar;
    bool is_checked;  /* the cell was checked (docs/execution.md), beginning with the token that has this checksum: */
    uint32_t checked; /* pn_crc32 of its scalars, as pn_scalars_format writes them; 0: there was no such token */
} pn_cell_input_t;

/* The other side of channels: a robot. */
typedef struct pn_cell_peer {
    const char *name; /* "robot1" */
    int32_t owner;    /* index in pn_net.owner */
} pn_cell_peer_t;

/* The supervisor host: what the program does from start to end, with a cell and without one. */
struct sup;
void sup_run_cell(struct sup *sup);
void sup_run_alone(struct sup *sup);

/* What this net needs besides what every supervisor does; NULL: nothing. Only what is named here is linked. */
typedef struct pn_cell_needs {
    void (*run)(struct sup *sup);            /* sup_run_cell; sup_run_alone: there is no cell */
    bool (*allow_files)(const char *folder); /* pn_file_allow: the net reads or writes files */
    void (*collect)(const pn_net_t *net, pn_ctx_t *cx,
                    void *marking); /* pn_marking_collect: values refer into the arena */
    bool (*next_time)(const pn_net_t *net, pn_ctx_t *cx, const void *marking,
                      pn_time_t *next); /* pn_next_time: it is timed */
} pn_cell_needs_t;

/* Memory of a program that has no heap. */
typedef struct pn_cell_room {
    void *marking; /* aligned as max_align_t */
    size_t marking_size;
    void *binding; /* likewise; as large as the largest binding */
    const size_t *binding_size;
    uint64_t *fired_of; /* for each transition */
    uint32_t transition_count;
} pn_cell_room_t;

typedef struct pn_cell {
    uint32_t abi;           /* PN_CELL_ABI */
    const char *name;       /* of the net, "cell" */
    const char *version;    /* of pn2code that generated this */
    const char *digest;     /* equals pn_net.digest */
    const char *side;       /* this party's name in files: "supervisor" */
    int32_t owner;          /* whose transitions this program plays; -1: all of them (no cell) */
    double reply_timeout_s; /* 0: none */
    uint32_t channel_count; /* data before flags, each in the order of cell.toml */
    const pn_cell_channel_t *channel;
    uint32_t between_count; /* files of channels between two peers: this program only makes them, empty (I7) */
    const char *const *between;
    uint32_t input_count;
    const pn_cell_input_t *input;
    uint32_t peer_count;
    const pn_cell_peer_t *peer;
    uint32_t final_count;
    const uint32_t *final_place;
    void *arena; /* memory for lists, strings and moves (pn_arena.h), aligned as max_align_t; or NULL */
    size_t arena_size;
    pn_cell_room_t room;
    pn_cell_needs_t needs;
} pn_cell_t;

extern const pn_cell_t pn_cell;

#ifdef __cplusplus
}
#endif

#endif /* PN_CELL_H */
