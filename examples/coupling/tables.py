"""Tables of the page, in Markdown."""


def markdown(head: list, rows: list[list]) -> str:
    """A table from its heading and its rows of cells."""
    line = "".join(f"| {cell} " if cell else "| " for cell in map(str, head)) + "|"
    return "\n".join([line, "|---" * len(head) + "|", *("| " + " | ".join(map(str, cells)) + " |" for cells in rows)])
