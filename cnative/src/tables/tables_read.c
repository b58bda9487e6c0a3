/* SPDX-License-Identifier: MIT
 * tables_read.c - a net and its questions, from text: numbers and words separated by white space.
 *
 *     places transitions
 *     initial marking: one number for each place
 *     for each transition: how many places it takes from, (place weight)..., how many it puts to, (place weight)...
 *     questions
 *     for each question: its number, and
 *         reach FORMULA | bound SUM | ctl FORMULA | ltl AUTOMATON
 *         guided N (transition times).. and one of them: a guess how the formula may become true, for walks
 *     order, and all places, from the top of a diagram downwards: where diagrams are wanted
 *     leaves, and for each place how many share its tokens in each possible way: where a net was made smaller, to count
 *     exact N (place values leaves..)..: places whose tokens are a value, or 0; an arc needs that value, and puts one;
 *         a sum has a term for each value
 *
 *     FORMULA    true | false | dead | not F | and N F.. | or N F.. | sum N (place factor).. limit
 *                | enabled N transition.. | among N ranges (first count).. (one of N transitions, in ranges)
 *                | EX F | AX F | EF F | AF F | EG F | AG F | EU F F | AU F F
 *     AUTOMATON  atoms FORMULA.. states, for each state: whether it accepts (0 or 1), how many moves,
 *                (target TRUE FALSE).., where TRUE and FALSE are numbers with the bits of the atoms that must be so
 *
 * The text comes from pn2code itself, so that an error in it is an error of the program; it is found all the same.
 */
#include "tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST_WORD = 64, DEEPEST = 10000 };

typedef struct reader {
    FILE *file;
    char word[LONGEST_WORD];
    tb_net_t *net;
    uint32_t depth;
} reader_t;

static const char *next_word(reader_t *r)
{
    if (fscanf(r->file, "%63s", r->word) != 1) {
        tb_fail(TB_EXIT_WRONG, "the tables end too early");
    }
    return r->word;
}

static int64_t number(reader_t *r, int64_t least, int64_t most)
{
    char *end = NULL;
    const char *word = next_word(r);
    const long long value = strtoll(word, &end, 10);
    if ((*end != '\0') || (value < least) || (value > most)) {
        tb_fail(TB_EXIT_WRONG, "`%s` is not a number from %lld to %lld", word, (long long)least, (long long)most);
    }
    return (int64_t)value;
}

static uint32_t index_below(reader_t *r, uint32_t count)
{
    return (uint32_t)number(r, 0, (int64_t)count - 1);
}

/* --- the net ------------------------------------------------------------------------------------------------------ */

typedef struct growing {
    tb_arc_t *arc;
    uint32_t count;
    uint32_t room;
} growing_t;

static void append(growing_t *g, uint32_t node, int32_t weight)
{
    if (g->count == g->room) {
        const uint32_t room = (g->room > 0U) ? (2U * g->room) : 1024U;
        g->arc = tb_grown(g->arc, g->room, room, sizeof *g->arc);
        g->room = room;
    }
    g->arc[g->count].node = node;
    g->arc[g->count].weight = weight;
    g->count++;
}

static void read_arcs(reader_t *r, growing_t *g)
{
    const uint32_t count = (uint32_t)number(r, 0, (int64_t)r->net->places);
    for (uint32_t i = 0U; i < count; i++) {
        const uint32_t place = index_below(r, r->net->places);
        append(g, place, (int32_t)number(r, 1, (int64_t)TB_MOST_TOKENS));
    }
}

/* The arcs of `from` nodes, by their other ends, of which there are `to`. */
static tb_arcs_t turned(const tb_arcs_t *arcs, uint32_t from, uint32_t to)
{
    tb_arcs_t back = { tb_new((size_t)to + 1U, sizeof(uint32_t)), tb_new(arcs->first[from], sizeof(tb_arc_t)) };
    uint32_t *next = tb_new((size_t)to + 1U, sizeof *next);
    for (uint32_t i = 0U; i < arcs->first[from]; i++) {
        back.first[arcs->arc[i].node + 1U]++;
    }
    for (uint32_t n = 0U; n < to; n++) {
        back.first[n + 1U] += back.first[n];
    }
    (void)memcpy(next, back.first, ((size_t)to + 1U) * sizeof *next);
    for (uint32_t n = 0U; n < from; n++) {
        for (uint32_t i = arcs->first[n]; i < arcs->first[n + 1U]; i++) {
            const tb_arc_t arc = { n, arcs->arc[i].weight };
            back.arc[next[arcs->arc[i].node]] = arc;
            next[arcs->arc[i].node]++;
        }
    }
    tb_free(next, (size_t)to + 1U, sizeof *next);
    return back;
}

/* What is put minus what is taken. */
static void make_changes(tb_net_t *net)
{
    int32_t *by = tb_new(net->places, sizeof *by);
    const uint32_t most = net->takes.first[net->transitions] + net->puts.first[net->transitions];
    net->changes.first = tb_new((size_t)net->transitions + 1U, sizeof(uint32_t));
    net->changes.arc = tb_new(most, sizeof(tb_arc_t));
    uint32_t made = 0U;
    for (uint32_t t = 0U; t < net->transitions; t++) {
        const tb_arcs_t *sides[2] = { &net->takes, &net->puts };
        for (uint32_t side = 0U; side < 2U; side++) {
            for (uint32_t i = sides[side]->first[t]; i < sides[side]->first[t + 1U]; i++) {
                const int32_t weight = sides[side]->arc[i].weight;
                by[sides[side]->arc[i].node] += (side == 0U) ? -weight : weight;
            }
        }
        for (uint32_t side = 0U; side < 2U; side++) {
            for (uint32_t i = sides[side]->first[t]; i < sides[side]->first[t + 1U]; i++) {
                const uint32_t p = sides[side]->arc[i].node;
                if (by[p] != 0) {
                    net->changes.arc[made].node = p;
                    net->changes.arc[made].weight = by[p];
                    made++;
                    by[p] = 0;
                }
            }
        }
        net->changes.first[t + 1U] = made;
    }
    tb_free(by, net->places, sizeof *by);
}

static void read_net(reader_t *r)
{
    tb_net_t *net = r->net;
    net->places = (uint32_t)number(r, 0, 50000000);
    net->transitions = (uint32_t)number(r, 0, 50000000);
    net->initial = tb_new(net->places, sizeof *net->initial);
    for (uint32_t p = 0U; p < net->places; p++) {
        net->initial[p] = (tb_count_t)number(r, 0, (int64_t)TB_MOST_TOKENS);
    }
    growing_t takes = { NULL, 0U, 0U };
    growing_t puts = { NULL, 0U, 0U };
    append(&takes, 0U, 0); /* so that there is an array even without arcs */
    append(&puts, 0U, 0);
    takes.count = 0U;
    puts.count = 0U;
    net->takes.first = tb_new((size_t)net->transitions + 1U, sizeof(uint32_t));
    net->puts.first = tb_new((size_t)net->transitions + 1U, sizeof(uint32_t));
    for (uint32_t t = 0U; t < net->transitions; t++) {
        read_arcs(r, &takes);
        read_arcs(r, &puts);
        net->takes.first[t + 1U] = takes.count;
        net->puts.first[t + 1U] = puts.count;
    }
    net->takes.arc = takes.arc;
    net->puts.arc = puts.arc;
    make_changes(net);
    net->takers = turned(&net->takes, net->transitions, net->places);
    net->changers = turned(&net->changes, net->transitions, net->places);
}

/* --- the questions ------------------------------------------------------------------------------------------------ */

static const struct {
    const char *word;
    tb_op_t op;
    uint32_t parts; /* UINT32_MAX: their number is written */
} operators[] = {
    { "not", TB_NOT, 1U }, { "and", TB_AND, UINT32_MAX }, { "or", TB_OR, UINT32_MAX }, { "EX", TB_EX, 1U },
    { "AX", TB_AX, 1U },   { "EF", TB_EF, 1U },           { "AF", TB_AF, 1U },         { "EG", TB_EG, 1U },
    { "AG", TB_AG, 1U },   { "EU", TB_EU, 2U },           { "AU", TB_AU, 2U },
};

static tb_formula_t *formula(reader_t *r, uint32_t *numbers);

static void read_sum(reader_t *r, tb_formula_t *f)
{
    f->op = TB_SUM;
    f->count = (uint32_t)number(r, 0, 100000000);
    f->term = tb_new(f->count, sizeof *f->term);
    for (uint32_t i = 0U; i < f->count; i++) {
        f->term[i].place = index_below(r, r->net->places);
        f->term[i].factor = number(r, -1000000000, 1000000000);
    }
    f->limit = number(r, INT64_MIN / 4, INT64_MAX / 4);
}

/* Bits for the transitions of which one is enabled, where they take no more room than the list. */
static void note_ones(const reader_t *r, tb_formula_t *f)
{
    if ((f->count > (uint32_t)TB_FEW) && (f->count > (r->net->transitions / 32U))) {
        f->is_one = tb_new(((size_t)r->net->transitions / 64U) + 1U, sizeof *f->is_one);
        for (uint32_t i = 0U; i < f->count; i++) {
            f->is_one[f->transition[i] / 64U] |= UINT64_C(1) << (f->transition[i] % 64U);
        }
    }
}

static void read_enabled(reader_t *r, tb_formula_t *f)
{
    f->op = TB_ENABLED;
    f->count = (uint32_t)number(r, 0, (int64_t)r->net->transitions);
    f->transition = tb_new(f->count, sizeof *f->transition);
    for (uint32_t i = 0U; i < f->count; i++) {
        f->transition[i] = index_below(r, r->net->transitions);
    }
    note_ones(r, f);
}

/* The same as ranges: how many transitions, how many ranges, and of each the first one and how many they are. */
static void read_among(reader_t *r, tb_formula_t *f)
{
    f->op = TB_ENABLED;
    f->count = (uint32_t)number(r, 0, (int64_t)r->net->transitions);
    f->transition = tb_new(f->count, sizeof *f->transition);
    const uint32_t ranges = (uint32_t)number(r, 0, (int64_t)r->net->transitions);
    uint32_t found = 0U;
    for (uint32_t i = 0U; i < ranges; i++) {
        const uint32_t first = index_below(r, r->net->transitions);
        const uint32_t most =
            (f->count - found) < (r->net->transitions - first) ? (f->count - found) : (r->net->transitions - first);
        const uint32_t count = (uint32_t)number(r, 0, (int64_t)most);
        for (uint32_t k = 0U; k < count; k++) {
            f->transition[found] = first + k;
            found++;
        }
    }
    if (found != f->count) {
        tb_fail(TB_EXIT_WRONG, "ranges of %u transitions, not of %u", found, f->count);
    }
    note_ones(r, f);
}

static void read_parts(reader_t *r, tb_formula_t *f, uint32_t parts, uint32_t *numbers)
{
    f->count = (parts == UINT32_MAX) ? (uint32_t)number(r, 0, 100000000) : parts;
    f->part = tb_new(f->count, sizeof(tb_formula_t *));
    f->is_temporal = f->op >= TB_EX;
    for (uint32_t i = 0U; i < f->count; i++) {
        f->part[i] = formula(r, numbers);
        f->is_temporal = f->is_temporal || f->part[i]->is_temporal;
    }
}

static tb_formula_t *formula(reader_t *r, uint32_t *numbers)
{
    tb_formula_t *f = tb_new(1U, sizeof *f);
    const char *word = next_word(r);
    r->depth++;
    if (r->depth > (uint32_t)DEEPEST) {
        tb_fail(TB_EXIT_WRONG, "a formula is nested too deeply");
    }
    if (strcmp(word, "true") == 0) {
        f->op = TB_TRUE;
    } else if (strcmp(word, "false") == 0) {
        f->op = TB_FALSE;
    } else if (strcmp(word, "dead") == 0) {
        f->op = TB_DEAD;
    } else if (strcmp(word, "sum") == 0) {
        read_sum(r, f);
    } else if (strcmp(word, "enabled") == 0) {
        read_enabled(r, f);
    } else if (strcmp(word, "among") == 0) {
        read_among(r, f);
    } else {
        size_t i = 0U;
        while ((i < (sizeof operators / sizeof operators[0])) && (strcmp(word, operators[i].word) != 0)) {
            i++;
        }
        if (i == (sizeof operators / sizeof operators[0])) {
            tb_fail(TB_EXIT_WRONG, "`%s` begins no formula", word);
        }
        f->op = operators[i].op;
        read_parts(r, f, operators[i].parts, numbers);
    }
    r->depth--;
    f->number = *numbers;
    (*numbers)++;
    return f;
}

static void read_automaton(reader_t *r, tb_question_t *q)
{
    tb_automaton_t *a = &q->automaton;
    a->atoms = (uint32_t)number(r, 0, TB_MOST_ATOMS);
    a->atom = tb_new(a->atoms, sizeof *a->atom);
    for (uint32_t i = 0U; i < a->atoms; i++) {
        a->atom[i] = formula(r, &q->formulas);
    }
    a->states = (uint32_t)number(r, 1, 1000000);
    a->is_accepting = tb_new(a->states, sizeof *a->is_accepting);
    a->first = tb_new((size_t)a->states + 1U, sizeof *a->first);
    uint32_t room = 0U;
    for (uint32_t s = 0U; s < a->states; s++) {
        a->is_accepting[s] = number(r, 0, 1) != 0;
        const uint32_t moves = (uint32_t)number(r, 0, 1000000);
        const uint32_t before = a->first[s];
        if ((before + moves) > room) {
            const uint32_t more = 2U * (before + moves);
            a->move = tb_grown(a->move, room, more, sizeof *a->move);
            room = more;
        }
        for (uint32_t i = 0U; i < moves; i++) {
            a->move[before + i].target = index_below(r, a->states);
            a->move[before + i].is_true = (uint64_t)number(r, 0, INT64_MAX);
            a->move[before + i].is_false = (uint64_t)number(r, 0, INT64_MAX);
        }
        a->first[s + 1U] = before + moves;
    }
}

static void read_guide(reader_t *r, tb_question_t *q)
{
    const uint32_t count = (uint32_t)number(r, 0, (int64_t)r->net->transitions);
    q->guide = tb_new(r->net->transitions, sizeof *q->guide);
    for (uint32_t i = 0U; i < count; i++) {
        const uint32_t t = index_below(r, r->net->transitions);
        q->guide[t] = (uint32_t)number(r, 1, (int64_t)TB_MOST_TOKENS);
    }
}

static void read_question(reader_t *r, tb_question_t *q)
{
    q->number = (uint32_t)number(r, 0, INT32_MAX);
    const char *word = next_word(r);
    if (strcmp(word, "guided") == 0) {
        read_guide(r, q);
        word = next_word(r);
    }
    if (strcmp(word, "ltl") == 0) {
        q->kind = TB_LTL;
        read_automaton(r, q);
        return;
    }
    q->kind = TB_CTL;
    if (strcmp(word, "reach") == 0) {
        q->kind = TB_REACH;
    } else if (strcmp(word, "bound") == 0) {
        q->kind = TB_BOUND;
    } else if (strcmp(word, "ctl") != 0) {
        tb_fail(TB_EXIT_WRONG, "`%s` is no kind of question", word);
    }
    q->formula = formula(r, &q->formulas);
    if (((q->kind == TB_BOUND) && (q->formula->op != TB_SUM)) || ((q->kind == TB_REACH) && q->formula->is_temporal)) {
        tb_fail(TB_EXIT_WRONG, "question %u is not of its kind", q->number);
    }
    q->least = INT64_MIN;
}

/* Each place once. */
static void read_order(reader_t *r, tb_job_t *job)
{
    bool *is_there = tb_new(job->net.places, sizeof *is_there);
    job->order = tb_new(job->net.places, sizeof *job->order);
    for (uint32_t i = 0U; i < job->net.places; i++) {
        job->order[i] = index_below(r, job->net.places);
        if (is_there[job->order[i]]) {
            tb_fail(TB_EXIT_WRONG, "place %u is in the order twice", job->order[i]);
        }
        is_there[job->order[i]] = true;
    }
    tb_free(is_there, job->net.places, sizeof *is_there);
}

static void read_leaves(reader_t *r, tb_job_t *job)
{
    job->leaves = tb_new(job->net.places, sizeof *job->leaves);
    for (uint32_t i = 0U; i < job->net.places; i++) {
        job->leaves[i] = (uint32_t)number(r, 1, INT32_MAX);
    }
}

static void read_exact(reader_t *r, tb_job_t *job)
{
    const uint32_t count = (uint32_t)number(r, 0, (int64_t)job->net.places);
    job->exact = tb_new(job->net.places, sizeof *job->exact);
    for (uint32_t i = 0U; i < count; i++) {
        const uint32_t place = index_below(r, job->net.places);
        const uint32_t values = (uint32_t)number(r, 1, (int64_t)TB_MOST_TOKENS);
        uint32_t *leaves = tb_new((size_t)values + 1U, sizeof *leaves);
        leaves[0] = values;
        for (uint32_t v = 1U; v <= values; v++) {
            leaves[v] = (uint32_t)number(r, 1, INT32_MAX);
        }
        job->exact[place] = leaves;
    }
}

/* What may stand at the end. */
static void read_rest(reader_t *r, tb_job_t *job)
{
    char word[LONGEST_WORD];
    while (fscanf(r->file, "%63s", word) == 1) {
        if (strcmp(word, "order") == 0) {
            read_order(r, job);
        } else if (strcmp(word, "leaves") == 0) {
            read_leaves(r, job);
        } else if (strcmp(word, "exact") == 0) {
            read_exact(r, job);
        } else {
            tb_fail(TB_EXIT_WRONG, "`%s` is not known at the end", word);
        }
    }
}

void tb_read(tb_job_t *job, const char *path)
{
    reader_t r = { fopen(path, "r"), { 0 }, &job->net, 0U };
    if (r.file == NULL) {
        tb_fail(TB_EXIT_WRONG, "cannot read `%s`", path);
    }
    read_net(&r);
    job->questions = (uint32_t)number(&r, 0, 10000000);
    job->question = tb_new(job->questions, sizeof *job->question);
    for (uint32_t i = 0U; i < job->questions; i++) {
        read_question(&r, &job->question[i]);
    }
    read_rest(&r, job);
    (void)fclose(r.file);
}
