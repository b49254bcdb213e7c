#!/usr/bin/env python3
"""Reads meson-logs/testlog.json, one object a line.

usage: results.py LOG            prints 'PASSED FAILED SKIPPED'; names what did not pass
                                 on standard error
       results.py LOG --digest   prints the hashes of the test 'digest'

What Python's unittest skips inside a test counts as skipped, and a test that skips all that it has
has not passed.
"""
import json
import re
import sys

PASSED = {"OK", "EXPECTEDFAIL"}


def reason(test):
    """The line in which a test says why it was skipped."""
    for line in (test.get("stdout") or "").splitlines() + (test.get("stderr") or "").splitlines():
        if "skip" in line.lower():
            return line.strip()
    return "no reason given"


def skipped_parts(test):
    """What a test that passed says it left out, each once."""
    text = (test.get("stdout") or "") + "\n" + (test.get("stderr") or "")
    return sorted({line[line.index("SKIP"):].strip() for line in text.splitlines()
                   if "SKIP:" in line or "[  SKIPPED ]" in line})


def skipped_cases(test):
    """How many cases unittest ran, skipped ones among them, and how many it skipped."""
    text = "\n" + (test.get("stderr") or "") + "\n" + (test.get("stdout") or "")
    skips = sum(map(int, re.findall(r"\n(?:OK|NO TESTS RAN) \(.*?\bskipped=(\d+)", text)))
    return max(skips, sum(map(int, re.findall(r"\nRan (\d+) tests? in ", text)))), skips


def main():
    with open(sys.argv[1], encoding="utf-8") as log:
        tests = [json.loads(line) for line in log if line.strip()]
    if sys.argv[2:] == ["--digest"]:
        for test in tests:
            if test["name"].split(" / ")[-1].split(":")[-1] == "digest":
                lines = (test.get("stdout") or "").splitlines()
                print("\n".join(line for line in lines if line.startswith("digest ")))
        return
    passed = failed = skipped = 0
    for test in tests:
        if test["result"] in PASSED:
            cases, skips = skipped_cases(test)
            skipped += skips
            if not cases or skips < cases:
                passed += 1
            if skips:
                print(f"    SKIPPED in {test['name']}: {skips} of {cases} cases", file=sys.stderr)
            for line in skipped_parts(test):
                print(f"    SKIPPED in {test['name']}: {line}", file=sys.stderr)
        elif test["result"] == "SKIP":
            skipped += 1
            print(f"    SKIPPED {test['name']}: {reason(test)}", file=sys.stderr)
        else:
            failed += 1
            print(f"    FAILED  {test['name']}: {test['result']}", file=sys.stderr)
            for line in (test.get("stdout", "") + test.get("stderr", "")).splitlines()[-25:]:
                print(f"            {line}", file=sys.stderr)
    print(passed, failed, skipped)


if __name__ == "__main__":
    main()
