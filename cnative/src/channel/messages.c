/* SPDX-License-Identifier: MIT
 * messages.c - host: the codec of a generated cell (pn_channel.c with its cell_config.c), asked message by message.
 * What `pn2code verify` and `generate` find in the channels of the state space goes through it; tests compare it with
 * the Python side.
 *
 * Reads commands, one a line, and answers each by a line. A value is a whole number (BOOL, INT, INDEX, UNIT, and the
 * position of an ENUM), a hexadecimal float (REAL), or `x` and bytes in hexadecimal (STRING):
 *
 *     write CHANNEL SEQ VALUE ...     the file's bytes in hexadecimal, or `unwritable`
 *     read CHANNEL CONSUMED HEX       `empty`, `message SEQ VALUE ...` (SEQ is `-` without line 2), or `refused REASON`
 */
#define _POSIX_C_SOURCE 200809L /* strtok_r */

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_channel.h"

#define LINE_SIZE ((size_t)1U << 24U)

static const char SESSION[] = "00000001";
static char s_line[LINE_SIZE];
static char s_text[LINE_SIZE / 2U]; /* strings of a message, one after the other */
static pn_message_t s_message;

static int digit(char c)
{
    return (c <= '9') ? (c - '0') : (c - 'a') + 10;
}

/* Bytes in hexadecimal; returns their number. */
static size_t from_hex(const char *hex, char *out, size_t capacity)
{
    size_t length = 0U;
    while ((hex[0] != '\0') && (hex[1] != '\0') && (length < capacity)) {
        out[length] = (char)((digit(hex[0]) * 16) + digit(hex[1]));
        length++;
        hex += 2;
    }
    return length;
}

static void print_hex(const char *bytes, size_t length)
{
    for (size_t i = 0U; i < length; i++) {
        (void)printf("%02x", (unsigned)(unsigned char)bytes[i]);
    }
}

static void scalar_of(const pn_scalar_t *scalar, const char *word, pn_scalar_value_t *scalar_value, size_t *used)
{
    *scalar_value = (pn_scalar_value_t){ .kind = PN_VALUE_INT };
    if (scalar->kind == PN_SCALAR_REAL) {
        scalar_value->real = strtod(word, NULL);
    } else if (scalar->kind == PN_SCALAR_STRING) {
        scalar_value->text = &s_text[*used];
        scalar_value->length = (uint32_t)from_hex(&word[1], &s_text[*used], sizeof s_text - *used);
        *used += scalar_value->length;
    } else {
        scalar_value->integer = strtoll(word, NULL, 10);
    }
}

static bool answer_write(const pn_cell_channel_t *channel, const char *seq, char **rest)
{
    static char file[PN_CHANNEL_TEXT];
    pn_scalar_value_t scalar_value[PN_CHANNEL_SCALARS];
    size_t used = 0U;
    pn_scalar_walk_t walk = { channel->scalar, channel->scalar_count, 0U, 0U, 0U, 0U };
    const pn_scalar_t *scalar = pn_scalar_next(&walk);
    uint32_t i = 0U;
    while (scalar != NULL) {
        const char *const word = strtok_r(NULL, " ", rest);
        if (word == NULL) {
            return false;
        }
        if (i >= PN_CHANNEL_SCALARS) {
            (void)printf("unwritable");
            return true;
        }
        scalar_of(scalar, word, &scalar_value[i], &used);
        pn_scalar_is(&walk, &scalar_value[i]);
        i++;
        scalar = pn_scalar_next(&walk);
    }
    const size_t length =
        pn_channel_compose(channel, scalar_value, strtoull(seq, NULL, 10), SESSION, file, sizeof file);
    if (length == 0U) {
        (void)printf("unwritable");
    }
    print_hex(file, length);
    return true;
}

static void print_scalar_value(const pn_scalar_t *scalar, const pn_scalar_value_t *scalar_value)
{
    if (scalar->kind == PN_SCALAR_REAL) {
        (void)printf(" %a", scalar_value->real);
    } else if (scalar->kind == PN_SCALAR_STRING) {
        (void)printf(" x");
        print_hex(scalar_value->text, scalar_value->length);
    } else {
        (void)printf(" %" PRId64, scalar_value->integer);
    }
}

static bool answer_read(const pn_cell_channel_t *channel, const char *consumed, char **rest)
{
    static const char *const why[] = { "none",    "missing",  "shape",   "count",    "scalar", "colour",
                                       "trailer", "checksum", "session", "repeated", "lost",   "overwritten" };
    static char file[PN_CHANNEL_TEXT];
    const char *const hex = strtok_r(NULL, " ", rest);
    const size_t length = from_hex((hex != NULL) ? hex : "", file, sizeof file);
    pn_scalar_walk_t walk = { channel->scalar, channel->scalar_count, 0U, 0U, 0U, 0U };
    switch (pn_channel_parse(channel, file, length, SESSION, strtoull(consumed, NULL, 10), &s_message)) {
    case PN_CHANNEL_EMPTY: (void)printf("empty"); return true;
    case PN_CHANNEL_MESSAGE:
        if (s_message.sealed) {
            (void)printf("message %" PRIu64, s_message.seq);
        } else {
            (void)printf("message -");
        }
        for (uint32_t i = 0U; i < s_message.count; i++) {
            print_scalar_value(pn_scalar_next(&walk), &s_message.value[i]);
            pn_scalar_is(&walk, &s_message.value[i]);
        }
        return true;
    case PN_CHANNEL_REFUSED: (void)printf("refused %s", why[s_message.refusal]); return true;
    case PN_CHANNEL_UNCHANGED:
    case PN_CHANNEL_BROKEN:
    default: return false;
    }
}

static bool answer(char *line)
{
    char *rest = NULL;
    const char *const verb = strtok_r(line, " ", &rest);
    const char *const index = strtok_r(NULL, " ", &rest);
    const char *const number = strtok_r(NULL, " ", &rest);
    if ((verb == NULL) || (index == NULL) || (number == NULL) || (strtoul(index, NULL, 10) >= pn_cell.channel_count)) {
        return false;
    }
    const pn_cell_channel_t *const channel = &pn_cell.channel[strtoul(index, NULL, 10)];
    if (channel->scalar_count > PN_CHANNEL_SCALARS) {
        return false;
    }
    return (strcmp(verb, "write") == 0) ? answer_write(channel, number, &rest) : answer_read(channel, number, &rest);
}

int main(void)
{
    while (fgets(s_line, (int)sizeof s_line, stdin) != NULL) {
        s_line[strcspn(s_line, "\n")] = '\0';
        if (!answer(s_line)) {
            return 2;
        }
        (void)putchar('\n');
    }
    return 0;
}
