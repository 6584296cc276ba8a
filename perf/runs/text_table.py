# SPDX-License-Identifier: BSD-3-Clause
"""Text tables of the benchmarks."""


def text(value, form="{:.2f}"):
    return "" if value is None else form.format(value) if isinstance(value, float) else str(value)


def table(header, rows):
    """Returns a Markdown table with aligned columns."""
    rows = [[text(cell) for cell in row] for row in rows]
    widths = [max(len(header[i]), *(len(row[i]) for row in rows)) if rows else len(header[i]) for i in range(len(header))]
    def line(cells):
        return "| " + " | ".join(cell.ljust(w) if i == 0 else cell.rjust(w)
                                 for i, (cell, w) in enumerate(zip(cells, widths))) + " |"
    rule = "|" + "|".join("-" * (w + 2) if i == 0 else "-" * (w + 1) + ":" for i, w in enumerate(widths)) + "|"
    return "\n".join([line(header), rule, *map(line, rows)])

