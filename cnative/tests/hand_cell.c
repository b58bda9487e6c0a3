/* SPDX-License-Identifier: MIT
 * hand_cell.c - the cell of hand_net.c, as cell_config.c would be generated. With -DHAND_ALONE a net without a cell.
 */
#include "pn/pn_arena.h"
#include "pn/pn_cell.h"
#include "pn/pn_file.h"
#include "pn/pn_marking.h"

#include <stddef.h>

#define HAND_ROOM                       \
    { .marking = s_marking,             \
      .marking_size = sizeof s_marking, \
      .binding = s_binding,             \
      .binding_size = &BINDING_SIZE,    \
      .fired_of = s_fired_of,           \
      .transition_count = 16U }
#define HAND_NEEDS , .allow_files = pn_file_allow, .collect = pn_marking_collect, .next_time = pn_next_time
static max_align_t s_marking[4096];
static max_align_t s_binding[64];
static const size_t BINDING_SIZE = sizeof s_binding;
static uint64_t s_fired_of[16];
static max_align_t s_arena[PN_ARENA_DEFAULT_SIZE / sizeof(max_align_t)];

#ifdef HAND_ALONE

const pn_cell_t pn_cell = {
    .abi = PN_CELL_ABI,
    .name = "hand",
    .version = "0",
    .digest = "0000",
    .side = "supervisor",
    .owner = -1,
    .arena = s_arena,
    .arena_size = sizeof s_arena,
    .room = HAND_ROOM,
    .needs = { .run = sup_run_alone HAND_NEEDS },
};

#else

static const pn_scalar_t POSE[] = {
    { .kind = PN_SCALAR_REAL, .label = "x", .colset = "COORD" },
    { .kind = PN_SCALAR_REAL, .label = "y", .colset = "COORD" },
};
static const pn_scalar_t FLAG[] = { { .kind = PN_SCALAR_INT, .label = "flag", .colset = "FLAG" } };
static const pn_scalar_t ORDER[] = {
    { .kind = PN_SCALAR_INT, .label = "n", .colset = "COUNT", .bounded = true, .low = 0, .high = 1000000000 },
    { .kind = PN_SCALAR_REAL, .label = "x", .colset = "COORD" },
    { .kind = PN_SCALAR_REAL, .label = "y", .colset = "COORD" },
};

static const pn_cell_channel_t CHANNEL[] = {
    { "pose1", "pose1.robcad", 4U, "Top.pose1", PN_CHANNEL_OUT, PN_CHANNEL_DATA, 0U, 2U, POSE },
    { "command", "command.robcad", 5U, "Top.command", PN_CHANNEL_OUT, PN_CHANNEL_FLAG, 0U, 1U, FLAG },
    { "answer", "answer.robcad", 6U, "Top.answer", PN_CHANNEL_IN, PN_CHANNEL_FLAG, 0U, 1U, FLAG },
};
static const pn_cell_input_t INPUT[] = { { "orders", "orders.txt", 0U, "Top.Orders", 3U, ORDER, false, 0U } };
static const pn_cell_peer_t PEER[] = { { "robot1", 1 } };
static const uint32_t FINAL[] = { 3U };

const pn_cell_t pn_cell = {
    .abi = PN_CELL_ABI,
    .name = "hand",
    .version = "0",
    .digest = "0000",
    .side = "supervisor",
    .owner = 0,
    .reply_timeout_s = 5.0,
    .channel_count = 3U,
    .channel = CHANNEL,
    .input_count = 1U,
    .input = INPUT,
    .peer_count = 1U,
    .peer = PEER,
    .final_count = 1U,
    .final_place = FINAL,
    .arena = s_arena,
    .arena_size = sizeof s_arena,
    .room = HAND_ROOM,
    .needs = { .run = sup_run_cell HAND_NEEDS },
};

#endif
