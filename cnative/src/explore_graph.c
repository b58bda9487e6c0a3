/* SPDX-License-Identifier: MIT
 * explore_graph.c - what needs the whole graph. */
#include "explore_impl.h"

bool ex_graph(ex_run_t *run)
{
    (void)run;
    return false;
}

void ex_graph_json(ex_run_t *run, FILE *out)
{
    (void)run;
    (void)fprintf(out, "\"dead\": [], \"graph\": null, \"traces\": []");
}
