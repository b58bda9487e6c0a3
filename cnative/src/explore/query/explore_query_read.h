/* SPDX-License-Identifier: MIT
 * explore_query_read.h - a file of questions being read: explore_query_read.c, explore_query_automaton.c.
 */
#ifndef EXPLORE_QUERY_READ_H
#define EXPLORE_QUERY_READ_H

#include "explore_query.h"

#define EX_MOST_WORDS 4096U /* of a line */

typedef struct ex_reader {
    ex_queries_t *queries;
    const char *path;
    char *rest; /* of the text */
    uint64_t line;
    uint64_t item_room;
    uint64_t question_room;
    bool is_of_orders; /* the questions that follow */
    const char *word[EX_MOST_WORDS];
    uint32_t words;
    ex_automaton_t *automaton; /* being read */
    uint64_t edge_room;
    bool is_wrong; /* a line has too many words */
} ex_reader_t;

/* --- explore_query_read.c --- */

/* Says what is wrong with a word; false. */
bool ex_complain(const ex_reader_t *r, const char *what, const char *word);
/* The next line that says something, in words; false at the end. */
bool ex_next_line(ex_reader_t *r);
/* A number below `end`. */
bool ex_read_number(const ex_reader_t *r, const char *word, uint64_t end, const char *what, uint32_t *number);
bool ex_read_item(const ex_reader_t *r, const char *word, uint32_t *number);
bool ex_read_transition(const ex_reader_t *r, const char *word, uint32_t *number);
/* Room for one more in a table, zeroed; NULL: no memory. */
void *ex_with_room(void *table, uint64_t used, uint64_t *room, size_t size);
bool ex_add_item(ex_reader_t *r, const ex_item_t *item);

/* --- explore_query_automaton.c --- */

/* The first line of the automaton of the last question. */
bool ex_begin_automaton(ex_reader_t *r);
/* A line of it; r->automaton is NULL after the last one. */
bool ex_read_automaton_line(ex_reader_t *r);
/* Items for the transitions for which fairness is assumed, which must not get numbers that lines count on: when all
 * lines are read. */
bool ex_add_fair_items(ex_reader_t *r, const ex_automaton_t *automaton);

#endif /* EXPLORE_QUERY_READ_H */
