/* SPDX-License-Identifier: MIT
 * pn_file.h - what a net can do with files: nothing, or what the host allows below one folder.
 *
 * Names are those of the net: relative ones are below the present folder (at first the allowed one), absolute ones must
 * lie below the allowed folder. Whatever is outside, also by `..` or by a link, is not there. Without an allowed folder
 * nothing is there, and what is written is dropped. What the net prints goes to the run's output, which is the standard
 * error output unless the host says otherwise.
 *
 * Functions that can fail leave the reason for pn_file_problem. Open files are not part of a marking. pn_file.c is for
 * POSIX; another system has a file of its own with the same functions.
 */
#ifndef PN_FILE_H
#define PN_FILE_H

#include <stdio.h>

#include "pn/pn_string.h"
#include "pn/pn_types.h"

/* --- for hosts --- */

/* Lets the net use files below a folder; false when there is no such folder. */
bool pn_file_allow(const char *folder);
/* Where the net prints to; NULL: nowhere. */
void pn_file_set_output(FILE *output);

/* --- for nets: the operations that TextIO and OS.FileSys are made from --- */

/* Handles of files that are written: dropped, the run's output, or a file. */
#define PN_FILE_NOWHERE INT64_C(0)
#define PN_FILE_OUTPUT  INT64_C(1)

/* Everything in a file; the empty string if it cannot be read. */
pn_string_t pn_file_read(pn_ctx_t *cx, pn_string_t name);
/* Opens a file for writing: a handle; -1 if it cannot be opened. */
int64_t pn_file_open(pn_ctx_t *cx, pn_string_t name, bool is_appended);
void pn_file_write(pn_ctx_t *cx, int64_t handle, pn_string_t text);
void pn_file_close(pn_ctx_t *cx, int64_t handle);

/* 0 make a folder, 1 remove an empty folder, 2 remove a file, 3 make a folder the present one. */
bool pn_file_change(pn_ctx_t *cx, int64_t what, pn_string_t name);
bool pn_file_rename(pn_ctx_t *cx, pn_string_t old_name, pn_string_t new_name);
bool pn_file_is_folder(pn_ctx_t *cx, pn_string_t name);
int64_t pn_file_size(pn_ctx_t *cx, pn_string_t name);
/* Whether something exists and can be used: 1 read, 2 written, 4 executed, summed up. */
bool pn_file_may(pn_ctx_t *cx, pn_string_t name, int64_t modes);
/* The absolute path of something that exists. */
pn_string_t pn_file_full_path(pn_ctx_t *cx, pn_string_t name);
/* The present folder. */
pn_string_t pn_file_here(pn_ctx_t *cx);
/* The names in a folder, sorted, each with a slash behind it. */
pn_string_t pn_file_names(pn_ctx_t *cx, pn_string_t name);

/* Whether the last operation has failed. */
bool pn_file_has_failed(void);
/* Why the last operation failed, in words and as the system's name ("noent"); empty if it did not. */
pn_string_t pn_file_problem(pn_ctx_t *cx);
pn_string_t pn_file_problem_name(void);

#endif /* PN_FILE_H */
