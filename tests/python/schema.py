"""Whether a schema accepts the scenes of a file that are good, and refuses those that are bad."""

import json
import sys
from pathlib import Path

import jsonschema

cases = json.loads(Path(sys.argv[1]).read_text())
jsonschema.Draft7Validator.check_schema(cases["schema"])
validator = jsonschema.Draft7Validator(cases["schema"])
for name, scene in cases["good"]:
    faults = [f"{fault.json_path}: {fault.message}" for fault in validator.iter_errors(scene)]
    assert not faults, (name, faults)
for name, scene in cases["bad"]:
    assert not validator.is_valid(scene), name
print(len(cases["good"]), "scenes are accepted,", len(cases["bad"]), "refused")
