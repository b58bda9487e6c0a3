/* SPDX-License-Identifier: MIT
 * scalars.c - the text form of messages, to be compared with the Python side. Reads commands, one a line:
 *
 *   format HEXFLOAT          prints pn_real_format of it
 *   crc TEXT                 prints pn_crc32 of it
 *   real TEXT                parses one real: its hex float, or `refused COLUMN REPORT`
 *   string TEXT              parses one string: itself in hexadecimal, formatted again
 *   scalar NUMBER TEXT       parses one scalar of the table below: as it is written again, or `refused COLUMN`
 *   file CONSUMED HEX        reads a channel's file (two reals, session 0123abcd) given in hexadecimal:
 *                            `empty`, `message X Y SEQ`, or `refused WHY`
 *   many TEXT                parses one integer more than a message may have: `refused COLUMN REPORT`, or OK
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pn/pn_channel.h"

static pn_message_t s_message;

static void parse(pn_scalar_kind_t kind, const char *text)
{
    const pn_scalar_t scalar = { .kind = kind, .label = "v", .colset = "C" };
    char again[PN_CHANNEL_TEXT];
    s_message.count = 0U;
    s_message.text_length = 0U;
    if (!pn_scalars_parse(&scalar, 1U, text, strlen(text), &s_message)) {
        (void)printf("refused %u %s\n", (unsigned)s_message.column, s_message.report);
    } else if (kind == PN_SCALAR_REAL) {
        (void)printf("%a\n", s_message.value[0].real);
    } else {
        const size_t length = pn_scalars_format(&scalar, 1U, s_message.value, again, sizeof again);
        for (const char *c = s_message.value[0].text; *c != '\0'; c++) {
            (void)printf("%02x", (unsigned)(unsigned char)*c);
        }
        (void)printf(" %.*s\n", (int)length, again);
    }
}

static void parse_scalar(const char *argument)
{
    static const char *const names[] = { "red", "green" };
    static const pn_scalar_t scalars[] = {
        { .kind = PN_SCALAR_UNIT, .label = "", .colset = "UNIT" },
        { .kind = PN_SCALAR_BOOL, .label = "", .colset = "BOOL" },
        { .kind = PN_SCALAR_ENUM, .label = "c", .colset = "COLOUR", .name_count = 2U, .name = names },
        { .kind = PN_SCALAR_INDEX, .label = "", .colset = "INDEX", .bounded = true, .low = 1, .high = 3 },
        { .kind = PN_SCALAR_INT, .label = "n", .colset = "RANGE", .bounded = true, .low = -2, .high = 8 },
        { .kind = PN_SCALAR_INT, .label = "", .colset = "INT" },
        { .kind = PN_SCALAR_REAL, .label = "", .colset = "SPAN", .bounded = true, .real_low = -1.5, .real_high = 2.5 },
    };
    char *text = NULL;
    char again[PN_CHANNEL_TEXT];
    const pn_scalar_t *const scalar = &scalars[strtoul(argument, &text, 10)];
    text += (*text == ' ') ? 1 : 0;
    s_message.count = 0U;
    s_message.text_length = 0U;
    if (!pn_scalars_parse(scalar, 1U, text, strlen(text), &s_message)) {
        (void)printf("refused %u\n", (unsigned)s_message.column);
        return;
    }
    const size_t length = pn_scalars_format(scalar, 1U, s_message.value, again, sizeof again);
    (void)printf("%.*s\n", (int)length, again);
}

static void parse_file(const char *argument)
{
    static const pn_scalar_t scalar[2] = {
        { .kind = PN_SCALAR_REAL, .label = "x", .colset = "C" },
        { .kind = PN_SCALAR_REAL, .label = "y", .colset = "C" },
    };
    static const pn_cell_channel_t channel = {
        .name = "pose1", .file = "pose1.robcad", .scalar_count = 2U, .scalar = scalar
    };
    static const char *const why[] = { "none",    "missing",  "shape",   "count",    "scalar", "colour",
                                       "trailer", "checksum", "session", "repeated", "lost",   "overwritten" };
    static char text[PN_CHANNEL_TEXT];
    char *hex = NULL;
    const unsigned long consumed = strtoul(argument, &hex, 10);
    size_t length = 0U;
    while ((*hex == ' ') || (*hex == '\t')) {
        hex++;
    }
    unsigned int byte = 0U;
    while ((length < sizeof text) && (sscanf(hex, "%2x", &byte) == 1)) {
        text[length] = (char)byte;
        length++;
        hex += 2;
    }
    switch (pn_channel_parse(&channel, text, length, "0123abcd", consumed, &s_message)) {
    case PN_CHANNEL_EMPTY: (void)puts("empty"); break;
    case PN_CHANNEL_MESSAGE:
        (void)printf("message %a %a %ld\n", s_message.value[0].real, s_message.value[1].real,
                     s_message.sealed ? (long)s_message.seq : -1L);
        break;
    case PN_CHANNEL_REFUSED: (void)printf("refused %s\n", why[s_message.refusal]); break;
    case PN_CHANNEL_UNCHANGED:
    case PN_CHANNEL_BROKEN:
    default: (void)puts("?"); break;
    }
}

static void parse_many(const char *text)
{
    static pn_scalar_t scalar[PN_CHANNEL_SCALARS + 1U];
    for (uint32_t i = 0U; i <= PN_CHANNEL_SCALARS; i++) {
        scalar[i] = (pn_scalar_t){ .kind = PN_SCALAR_INT, .label = "n", .colset = "INT" };
    }
    s_message.count = 0U;
    s_message.text_length = 0U;
    if (pn_scalars_parse(scalar, PN_CHANNEL_SCALARS + 1U, text, strlen(text), &s_message)) {
        (void)puts("OK");
    } else {
        (void)printf("refused %u %s\n", (unsigned)s_message.column, s_message.report);
    }
}

int main(void)
{
    static char line[16384];
    while (fgets(line, (int)sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        char text[512] = "";
        if (strncmp(line, "format ", 7U) == 0) {
            (void)pn_real_format(strtod(line + 7, NULL), text, sizeof text);
            (void)puts(text);
        } else if (strncmp(line, "crc ", 4U) == 0) {
            (void)printf("%08x\n", (unsigned)pn_crc32(0U, line + 4, strlen(line + 4)));
        } else if (strncmp(line, "real ", 5U) == 0) {
            parse(PN_SCALAR_REAL, line + 5);
        } else if (strncmp(line, "string ", 7U) == 0) {
            parse(PN_SCALAR_STRING, line + 7);
        } else if (strncmp(line, "scalar ", 7U) == 0) {
            parse_scalar(line + 7);
        } else if (strncmp(line, "file ", 5U) == 0) {
            parse_file(line + 5);
        } else if (strncmp(line, "many ", 5U) == 0) {
            parse_many(line + 5);
        } else {
            return 2;
        }
    }
    return 0;
}
