"""Tables of the page, in Markdown."""


def markdown(head: list, rows: list[list]) -> str:
    """A table from its heading and its rows of cells."""
    return "\n".join("| " + " | ".join(map(str, cells)) + " |" for cells in (head, ["---"] * len(head), *rows))
