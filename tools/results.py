"""What a run of dgmpm has written, in a form in which two runs can be compared byte by byte."""

import json


def without_clocks(text):
    """Numbers of summary.json that no clock has a part in, and neither memory nor the number of threads."""
    words = ("second", "phases", "memory", "threads", "effects", "bytes")
    return {key: value for key, value in json.loads(text).items() if not any(word in key for word in words)}


def results(root):
    """The files of a run by name, but for clocks, matrices and checkpoints."""
    out = {}
    for path in sorted(root.rglob("*")):
        name = str(path.relative_to(root))
        if path.is_dir() or name.startswith("checkpoints/") or name in ("operators.h5", ".dgmpm"):
            continue
        data = path.read_bytes()
        if name == "summary.json":
            data = repr(without_clocks(data)).encode()
        if name == "regrid.csv":  # Its last columns are seconds.
            data = b"\n".join(b",".join(line.split(b",")[:12]) for line in data.splitlines())
        out[name] = data
    return out


def differences(one, two):
    """Files that differ between two results."""
    return sorted(name for name in one.keys() | two.keys() if one.get(name) != two.get(name))
