"""Times several programs on the same task by turns, so that all meet the same neighbours."""

import statistics
import time


def take_turns(programs, rounds):
    """programs: name to a function without arguments. Gives, by name, the processor time of each
    call in seconds and what the last call returned."""
    seconds = {name: [] for name in programs}
    results = {}
    for _ in range(rounds):
        for name, program in programs.items():
            start_s = time.process_time()
            results[name] = program()
            seconds[name].append(time.process_time() - start_s)
    return seconds, results


def median(values):
    return statistics.median(values) if len(values) else float("nan")
