"""Tables of what was measured: one row for each program on each problem, ours first."""

import json

OURS = "lodemark"


class Report:
    def __init__(self):
        self.rows = []

    def add(self, part, problem, program, time_ms, **measures):
        """time_ms is of what the part's title says. The first row of a problem that is ours is
        what the others are compared with."""
        row = {"part": part, "problem": problem, "program": program, "time_ms": time_ms}
        ours = next((r for r in self.rows if (r["part"], r["problem"]) == (part, problem)), None)
        if ours is not None and ours["program"].startswith(OURS):
            row["ratio"] = ours["time_ms"] / time_ms
        self.rows.append(row | measures)

    def print_part(self, part, title):
        rows = [row for row in self.rows if row["part"] == part]
        if not rows:
            return
        measures = [name for name in rows[0] if name not in ("part", "problem", "program")]
        measures = ["time_ms"] + [name for name in measures if name not in ("time_ms", "ratio")]
        names = ["problem", "program", *measures, "ratio"]
        print(f"\n{title}\n")
        print("| " + " | ".join(name.replace("_", " ") for name in names) + " |")
        print("|" + " --- |" * len(names))
        for row in rows:
            print("| " + " | ".join(_text(row.get(name)) for name in names) + " |", flush=True)

    def write_json(self, path, about):
        with open(path, "w") as file:
            json.dump({"about": about, "rows": self.rows}, file, indent=1)
            file.write("\n")


def _text(value):
    if value is None:
        return "–"
    if isinstance(value, float):
        return f"{value:.3g}" if abs(value) < 100 else f"{value:.0f}"
    return str(value)
