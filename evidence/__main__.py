import argparse
import sys
import tempfile
from pathlib import Path

from . import PAGES, ROOT, __doc__
from .page import differs, write


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m evidence", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", metavar="PAGE", default=list(PAGES), help=", ".join(PAGES))
    parser.add_argument("--check", action="store_true", help="compare with docs/ and write nothing there")
    arguments = parser.parse_args()
    if unknown := set(arguments.pages) - set(PAGES):
        parser.error(f"no page is called {', '.join(unknown)}; there are {', '.join(PAGES)}")
    wrong = []
    for name in arguments.pages:
        with tempfile.TemporaryDirectory() as folder:
            page = write(name, Path(folder) if arguments.check else ROOT / "docs")
            if arguments.check and differs(page, ROOT / "docs" / PAGES[name] / page.name):
                wrong.append(name)
        print(f"{name}: {'compared' if arguments.check else page}", flush=True)
    if wrong:
        sys.exit(f"docs/ has other words or numbers: python -m evidence {' '.join(wrong)}")


if __name__ == "__main__":
    main()
