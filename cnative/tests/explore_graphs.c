/* SPDX-License-Identifier: MIT
 * explore_graphs.c - components, home, liveness and fairness of small random graphs against their definitions:
 * `explore_graphs SEED COUNT`.
 *
 * Compiled with TRANSITIONS, so many labels, and NODES, at most so many. Prints `fine`, or what is wrong.
 */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../src/explore/graph/explore_graph.h"

enum { ARCS = (2 * NODES) + 6, WORDS = (NODES / 64) + 1 };

const pn_net_t pn_net = { .transition_count = TRANSITIONS };

static uint64_t s_random;

static uint32_t draw(uint32_t below)
{
    s_random = (s_random * 6364136223846793005U) + 1442695040888963407U;
    return (uint32_t)ex_scaled(s_random ^ (s_random << 29U), below);
}

/* --- what the sources under test call ----------------------------------------------------------------------------- */

typedef struct job {
    ex_worker_t *worker;
    void (*work)(ex_worker_t *worker, void *user);
    void *user;
    pthread_t thread;
} job_t;

static void *start(void *user)
{
    const job_t *const job = user;
    job->work(job->worker, job->user);
    return NULL;
}

void ex_parallel(ex_run_t *run, void (*work)(ex_worker_t *worker, void *user), void *user)
{
    job_t job = { .worker = &run->worker[1], .work = work, .user = user };
    const bool is_started = (run->options.threads > 1U) && (pthread_create(&job.thread, NULL, start, &job) == 0);
    work(&run->worker[0], user);
    if (is_started) {
        (void)pthread_join(job.thread, NULL);
    }
}

/* --- a graph, and what follows from the definitions --------------------------------------------------------------- */

typedef struct arc {
    uint32_t from;
    uint32_t to;
    uint16_t label;
} arc_t;

static uint32_t s_nodes;
static uint32_t s_arcs;
static arc_t s_arc[ARCS];
static uint64_t s_row[NODES + 1];
static uint32_t s_target[ARCS];
static uint16_t s_label[ARCS];

/* Random arcs; then what can be reached from node 0, numbered breadth first. */
static void make_graph(void)
{
    uint32_t number[NODES] = { 0U };
    uint32_t order[NODES] = { 0U };
    arc_t raw[ARCS];
    const uint32_t wanted = 1U + draw((uint32_t)NODES);
    const uint32_t count = draw((2U * wanted) + 6U);
    const uint32_t labels = 1U + draw(3U);
    const bool is_forward = draw(3U) == 0U;
    for (uint32_t i = 0U; i < count; i++) {
        raw[i] = (arc_t){ draw(wanted), draw(wanted), (uint16_t)(draw(labels) * (TRANSITIONS / labels)) };
        if (is_forward && (raw[i].from > raw[i].to) && (draw(8U) > 0U)) {
            raw[i] = (arc_t){ raw[i].to, raw[i].from, raw[i].label };
        }
    }
    s_nodes = 1U;
    s_arcs = 0U;
    number[0] = 1U;
    for (uint32_t node = 0U; node < s_nodes; node++) {
        s_row[node] = s_arcs;
        for (uint32_t i = 0U; i < count; i++) {
            if (raw[i].from != order[node]) {
                continue;
            }
            if (number[raw[i].to] == 0U) {
                order[s_nodes] = raw[i].to;
                s_nodes += 1U;
                number[raw[i].to] = s_nodes;
            }
            s_arc[s_arcs] = (arc_t){ node, number[raw[i].to] - 1U, raw[i].label };
            s_target[s_arcs] = s_arc[s_arcs].to;
            s_label[s_arcs] = raw[i].label;
            s_arcs += 1U;
        }
        s_row[node + 1U] = s_arcs;
    }
}

typedef uint64_t nodes_t[WORDS];   /* a set */
typedef nodes_t relation_t[NODES]; /* of each node those that it is related to */

/* Where a transition is enabled. */
static void find_enabled(nodes_t enabled, uint32_t t)
{
    (void)memset(enabled, 0, sizeof(nodes_t));
    for (uint32_t i = 0U; i < s_arcs; i++) {
        if (s_arc[i].label == t) {
            EX_SET_BIT(enabled, s_arc[i].from);
        }
    }
}

static bool have_common(const nodes_t a, const nodes_t b)
{
    uint64_t common = 0U;
    for (uint32_t w = 0U; w < (uint32_t)WORDS; w++) {
        common |= a[w] & b[w];
    }
    return common != 0U;
}

/* From where to where there is a way of at least one arc, without a transition, and, if so wished, only where it is
 * enabled. */
static void find_paths(relation_t reaches, uint32_t without, bool is_among_enabled)
{
    nodes_t enabled;
    find_enabled(enabled, without);
    (void)memset(reaches, 0, sizeof(relation_t));
    for (uint32_t i = 0U; i < s_arcs; i++) {
        const bool is_inside =
            !is_among_enabled || ((EX_BIT(enabled, s_arc[i].from) & EX_BIT(enabled, s_arc[i].to)) != 0U);
        if ((s_arc[i].label != without) && is_inside) {
            EX_SET_BIT(reaches[s_arc[i].from], s_arc[i].to);
        }
    }
    for (uint32_t k = 0U; k < s_nodes; k++) {
        for (uint32_t i = 0U; i < s_nodes; i++) {
            for (uint32_t w = 0U; (EX_BIT(reaches[i], k) != 0U) && (w < (uint32_t)WORDS); w++) {
                reaches[i][w] |= reaches[k][w];
            }
        }
    }
}

/* Whether there is a cycle through one of those nodes; NULL: through any. */
static bool has_cycle(relation_t reaches, const uint64_t *among)
{
    bool is_found = false;
    for (uint32_t i = 0U; i < s_nodes; i++) {
        is_found = is_found || ((EX_BIT(reaches[i], i) != 0U) && ((among == NULL) || (EX_BIT(among, i) != 0U)));
    }
    return is_found;
}

static uint8_t fairness_of(uint32_t t)
{
    relation_t reaches;
    nodes_t enabled;
    find_enabled(enabled, t);
    find_paths(reaches, t, false);
    if (!has_cycle(reaches, NULL)) {
        return (uint8_t)EX_IMPARTIAL;
    }
    if (!has_cycle(reaches, enabled)) {
        return (uint8_t)EX_FAIR;
    }
    find_paths(reaches, t, true);
    return (uint8_t)(!has_cycle(reaches, NULL) ? EX_JUST : EX_UNFAIR);
}

static bool s_is_fine;

static void check(bool is_fine, const char *what)
{
    if (!is_fine) {
        (void)printf("%s\n", what);
        s_is_fine = false;
    }
}

static void check_components(const ex_graph_t *g, relation_t reaches)
{
    uint32_t home = 0U;
    uint64_t between = 0U;
    uint32_t most = 0U;
    for (uint32_t i = 0U; i < s_nodes; i++) {
        bool is_home = true;
        for (uint32_t j = 0U; j < s_nodes; j++) {
            const bool there = EX_BIT(reaches[i], j) != 0U;
            const bool back = EX_BIT(reaches[j], i) != 0U;
            const bool is_one = (i == j) || (there && back);
            is_home = is_home && ((i == j) || back);
            check((g->component[i] == g->component[j]) == is_one, "components");
            check(is_one || !there || (g->component[i] > g->component[j]), "order of components");
        }
        check((g->component[i] == g->home_component) == is_home, "home component");
        home += is_home ? 1U : 0U;
        most = (g->component[i] > most) ? g->component[i] : most;
    }
    for (uint32_t i = 0U; i < s_arcs; i++) {
        between += ((s_arc[i].from != s_arc[i].to) && (EX_BIT(reaches[s_arc[i].to], s_arc[i].from) == 0U)) ? 1U : 0U;
    }
    check(g->components == (most + 1U), "number of components");
    check(g->component_arcs == between, "arcs between components");
    check(g->home_count == home, "home markings");
    check(g->is_acyclic == !has_cycle(reaches, NULL), "acyclic");
}

static void check_live(const ex_graph_t *g, relation_t reaches)
{
    for (uint32_t t = 0U; t < (uint32_t)TRANSITIONS; t++) {
        bool is_live = true;
        nodes_t enabled;
        find_enabled(enabled, t);
        for (uint32_t i = 0U; i < s_nodes; i++) {
            is_live = is_live && ((EX_BIT(enabled, i) != 0U) || have_common(reaches[i], enabled));
        }
        check(g->is_live[t] == is_live, "live");
    }
}

static void try_graph(ex_run_t *run)
{
    relation_t reaches;
    nodes_t dead = { 0U };
    ex_graph_t g = {
        .row = s_row, .target = s_target, .label = s_label, .dead = dead, .is_whole = true, .home_component = EX_NO_NODE
    };
    make_graph();
    g.nodes = s_nodes;
    g.arcs = s_arcs;
    for (uint32_t node = 0U; node < s_nodes; node++) {
        g.dead_count += (s_row[node] == s_row[node + 1U]) ? 1U : 0U;
    }
    find_paths(reaches, UINT32_MAX, false);
    s_is_fine = true;
    check(ex_components(run, &g) && ex_properties(run, &g) && (g.is_acyclic || ex_fairness(run, &g)), "no memory");
    if (s_is_fine) {
        check_components(&g, reaches);
        check_live(&g, reaches);
    }
    for (uint32_t t = 0U; s_is_fine && !g.is_acyclic && (t < (uint32_t)TRANSITIONS); t++) {
        check(g.fairness[t] == fairness_of(t), "fairness");
    }
    ex_free(&run->memory, g.component, (uint64_t)g.nodes * sizeof *g.component);
    ex_free_table(&run->memory, g.is_live, TRANSITIONS, sizeof *g.is_live);
    ex_free_table(&run->memory, g.fairness, TRANSITIONS, sizeof *g.fairness);
    check(atomic_load(&run->memory.used) == 0U, "memory is kept");
}

int main(int argc, char **argv)
{
    static ex_run_t s_run;
    static ex_worker_t s_worker[2];
    s_random = (argc > 1) ? strtoull(argv[1], NULL, 10) : 1U;
    const unsigned long count = (argc > 2) ? strtoul(argv[2], NULL, 10) : 1000U;
    s_run.worker = s_worker;
    s_worker[0].run = &s_run;
    s_worker[1].run = &s_run;
    s_run.memory.limit = (uint64_t)1U << 30U;
    for (unsigned long i = 0U; i < count; i++) {
        s_run.options.threads = 1U + (uint32_t)(i % 2U);
        try_graph(&s_run);
        if (!s_is_fine) {
            (void)printf("in graph %lu of %" PRIu32 " nodes:", i, s_nodes);
            for (uint32_t k = 0U; k < s_arcs; k++) {
                (void)printf(" %" PRIu32 "-%u->%" PRIu32, s_arc[k].from, s_label[k], s_arc[k].to);
            }
            (void)printf("\n");
            return 1;
        }
    }
    (void)printf("fine\n");
    return 0;
}
