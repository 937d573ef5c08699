"""`manifest.json`: what made each file, how precisely, and its SHA-256.

    python manifest.py

records table1.csv, which is made by hand; the generators record their own files.
"""

import hashlib
import json
from pathlib import Path

NAME = "manifest.json"


def write(path: Path, lines: list) -> None:
    """Write `lines` as a text file, through a temporary name so that no half file is ever left."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(path.suffix + ".part")
    temporary.write_text("\n".join(lines) + "\n", newline="\n")
    temporary.replace(path)


def record(out: Path, entries: dict) -> None:
    """Add `entries`, {file relative to `out`: {digits, precision_bits, generator, command}}."""
    path = out / NAME
    files = json.loads(path.read_text())["files"] if path.exists() else {}
    for name, entry in entries.items():
        digest = hashlib.sha256((out / name).read_bytes()).hexdigest()
        files[name] = {"sha256": digest, **entry}
    files = {name: files[name] for name in sorted(files) if (out / name).exists()}
    write(path, [json.dumps({"schema": 1, "files": files}, indent=1)])


def main() -> None:
    """Record the one file made by hand."""
    entry = {"digits": 6, "precision_bits": None, "generator": "transcribed from the paper", "command": None}
    record(Path(__file__).resolve().parent, {"table1.csv": entry})


if __name__ == "__main__":
    main()
