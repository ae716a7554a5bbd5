"""A light check of JSON by a JSON Schema, as far as `octafront schema` goes; a keyword that it does not know is an error."""
import functools
import json
import re
import subprocess

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}
SAID_ONLY = {"$schema", "$defs", "$comment", "title", "description", "default"}


@functools.cache
def schema_of(octafront):
    done = subprocess.run([octafront, "schema"], capture_output=True, check=True, timeout=60)
    return json.loads(done.stdout)


def is_of(value, name):
    if name in ("number", "integer"):
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return is_number and (name == "number" or value == int(value))
    return isinstance(value, TYPES[name])


def breaches(value, schema, root=None, at="$"):
    """What of the value is not as the schema says, in words."""
    root = root or schema
    if schema in (True, False):
        return [] if schema else [f"{at}: nobody knows it"]
    found = []
    for key, rule in schema.items():
        if key in SAID_ONLY or key in ("additionalProperties", "then"):
            continue
        elif key == "$ref":
            found += breaches(value, functools.reduce(lambda part, name: part[name], rule.split("/")[1:], root), root, at)
        elif key == "type":
            if not any(is_of(value, name) for name in ([rule] if isinstance(rule, str) else rule)):
                found.append(f"{at}: {value!r} is no {rule}")
        elif key == "required":
            found += [f"{at}: no {name}" for name in rule if isinstance(value, dict) and name not in value]
        elif key in ("properties", "patternProperties"):
            pass  # below
        elif key == "items":
            for i, item in enumerate(value if isinstance(value, list) else []):
                found += breaches(item, rule, root, f"{at}[{i}]")
        elif key in ("minItems", "maxItems"):
            if isinstance(value, list) and (len(value) < rule if key == "minItems" else len(value) > rule):
                found.append(f"{at}: {len(value)} items")
        elif key == "const":
            found += [] if value == rule else [f"{at}: {value!r} is not {rule!r}"]
        elif key == "enum":
            found += [] if value in rule else [f"{at}: {value!r} is none of {rule}"]
        elif key == "pattern":
            found += [] if not isinstance(value, str) or re.search(rule, value) else [f"{at}: {value!r} is not {rule}"]
        elif key in ("minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"):
            holds = {"minimum": value >= rule, "maximum": value <= rule, "exclusiveMinimum": value > rule,
                     "exclusiveMaximum": value < rule}[key]
            found += [] if holds else [f"{at}: {value} breaks {key} {rule}"]
        elif key == "anyOf":
            found += [] if any(not breaches(value, one, root, at) for one in rule) else [f"{at}: {value!r} is none of several"]
        elif key == "allOf":
            for one in rule:
                found += breaches(value, one, root, at)
        elif key == "if":
            if not breaches(value, rule, root, at):
                found += breaches(value, schema.get("then", True), root, at)
        else:
            raise ValueError(f"{at}: this check does not know {key}")
    if isinstance(value, dict):
        for name, item in value.items():
            rules = [schema.get("properties", {}).get(name)] + [
                rule for pattern, rule in schema.get("patternProperties", {}).items() if re.search(pattern, name)]
            rules = [rule for rule in rules if rule is not None] or [schema.get("additionalProperties", True)]
            for rule in rules:
                found += breaches(item, rule, root, f"{at}.{name}")
    return found


def expect_report(test, octafront, report):
    """Fails the test if a report of --json is not as `octafront schema` says."""
    test.assertEqual(breaches(report, schema_of(octafront)), [])
