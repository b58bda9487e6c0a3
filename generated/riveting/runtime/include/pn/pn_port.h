/* SPDX-License-Identifier: MIT
 * pn_port.h - everything the hosts ask of the operating system: clock, waiting, signals, files, locks.
 *
 * Functions that can fail return 0 or an error number (errno.h). Names are relative to a directory that was opened
 * once, so that a directory that is moved or replaced under a running program is noticed instead of followed.
 */
#ifndef PN_PORT_H
#define PN_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define PN_PORT_CHECK __attribute__((warn_unused_result))
#else
#define PN_PORT_CHECK
#endif

/* --- time and signals --------------------------------------------------------------------------------------------- */

/* Nanoseconds of a clock that never goes back: where the system's does, or cannot be read, it stands still. */
uint64_t pn_port_now(void);

/* A number that differs from run to run; names a session. */
uint32_t pn_port_unique(void);

uint64_t pn_port_pid(void);

/* SIGINT and SIGTERM are remembered and wake pn_port_wait; SIGPIPE and SIGXFSZ are ignored, so that writes report
 * errors. */
PN_PORT_CHECK int pn_port_signals(void);

/* The signal that asked this program to stop, 0 if none did. */
int pn_port_stop_signal(void);

/* Waits until the descriptor (-1: none) can be read, a signal asks to stop, or the time is over (UINT64_MAX: no limit).
 * Returns whether the descriptor can be read. */
bool pn_port_wait(int descriptor, uint64_t timeout_ns);

/* Reads what is there from a descriptor, at most `capacity` bytes: their number, 0 at the end of the file and where it
 * cannot be read, -1 when a signal interrupted. */
long pn_port_receive(int descriptor, char *buffer, size_t capacity);

/* --- directories and files ---------------------------------------------------------------------------------------- */

/* Opens a directory; with `create` it is made when missing (one level, access for its owner only). */
PN_PORT_CHECK int pn_port_dir_open(const char *path, bool create, int *directory);

/* False when the directory has been removed. */
bool pn_port_dir_exists(int directory);

void pn_port_close(int descriptor);

/* Reads a whole file by its path, cut at `capacity`; the only one that need not lie in a directory that was opened. */
PN_PORT_CHECK int pn_port_load(const char *path, char *buffer, size_t capacity, size_t *length);

/* Reads a whole small file, cut at `capacity`; `*length` tells how much was read. With `held` the descriptor is kept
 * open: as long as it is, replacing the file does not have to free it, which makes that a third quicker. On an error it
 * is -1. */
PN_PORT_CHECK int pn_port_read(int directory, const char *name, char *buffer, size_t capacity, size_t *length,
                               int *held);

/* Writes a file beside its place and renames it over it. On an error the temporary file is removed and the old file
 * stands. */
PN_PORT_CHECK int pn_port_publish(int directory, const char *name, const char *temporary, const char *data,
                                  size_t length);

/* The same in two halves, so that the slow one can be done while there is nothing to do: makes and opens the temporary
 * file, with the beginning of its content (`length` may be 0) ... */
PN_PORT_CHECK int pn_port_prepare(int directory, const char *temporary, const char *data, size_t length, int *file);
/* ... and writes (what `pn_port_prepare` has not written already) and renames it. Closing the descriptor can wait, too.
 */
PN_PORT_CHECK int pn_port_publish_prepared(int directory, const char *name, const char *temporary, int file,
                                           const char *data, size_t length);

void pn_port_remove(int directory, const char *name);

/* --- status files (locked by the party that they are about, written in place) ------------------------------------- */

/* Opens (makes) a file, empties and locks it; EWOULDBLOCK when another process holds the lock. Nobody finds it locked
 * before it is empty. */
PN_PORT_CHECK int pn_port_lock(int directory, const char *name, int *file);

/* Replaces the content of a locked file by one write. */
PN_PORT_CHECK int pn_port_rewrite(int file, const char *data, size_t length);

/* Whether some process holds the lock of the file; `*exists` tells whether there is a file. */
PN_PORT_CHECK int pn_port_probe(int directory, const char *name, bool *exists, bool *locked);

/* --- noticing changes --------------------------------------------------------------------------------------------- */

/* Watches for files that appear in the directory or are closed after writing. `*watch` is -1 where the system has no
 * such service (then one must poll). */
PN_PORT_CHECK int pn_port_watch(const char *path, int *watch);

typedef void (*pn_port_change_t)(void *user, const char *name);

/* Passes on the names of the files that changed since the last call, NULL for "anything may have changed". Does not
 * wait. False when the directory is gone. */
bool pn_port_changes(int watch, pn_port_change_t change, void *user);

#endif /* PN_PORT_H */
