/* SPDX-License-Identifier: MIT
 * conform_tables.h - what a program under test says of itself: cell_config.c, and the tables of net.c.
 */
#ifndef CONFORM_TABLES_H
#define CONFORM_TABLES_H

#include "pn/pn_text.h"

/* Appends {"cell": {...}, "net": {...}}. */
void conform_tables(pn_text_t *text);

#endif /* CONFORM_TABLES_H */
