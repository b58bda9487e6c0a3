"""Drawing pages as their authors laid them out: `svg.draw_page`, `svg.draw_pages`, `html.draw_net`."""
