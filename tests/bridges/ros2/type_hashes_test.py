#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The hashes in message_types.h are those of the types in ros_types.idl, as REP 2011 computes them.

Those of Twist, TwistStamped, Odometry and Path equal what users of ROS 2 have published.
"""
import hashlib
import json
import re
import unittest
from pathlib import Path

BRIDGE = Path(__file__).resolve().parents[3] / "bridges" / "ros2"
# Numbers of type_description_interfaces/msg/FieldType.
NESTED, ARRAY, SEQUENCE = 1, 48, 144
FIELD_TYPES = {"int8": 2, "long": 6, "unsigned long": 7, "float": 10, "double": 11, "string": 17}
FIELD = re.compile(r"(sequence<)?([\w: ]+?)>? (\w+)(?:\[(\d+)\])?$")


def descriptions(idl):
    """The description of each type by its name, such as nav_msgs/msg/Path."""
    found = {}
    for package, body in re.findall(r"module (\w+) \{ module msg \{ module dds_ \{(.*?)\}; \}; \};", idl, re.S):
        for name, fields in re.findall(r"struct (\w+)_ \{(.*?)\s*\};", body, re.S):
            found[f"{package}/msg/{name}"] = [field(text.strip(), package) for text in fields.split(";") if text.strip()]
    return {name: {"type_name": name, "fields": fields} for name, fields in found.items()}


def field(text, package):
    sequence, kind, name, length = FIELD.match(text).groups()
    nested = ""
    if kind not in FIELD_TYPES:
        nested = f"{kind.split('::')[0] if '::' in kind else package}/msg/{kind.split('::')[-1].rstrip('_')}"
    number = FIELD_TYPES.get(kind, NESTED) + (SEQUENCE if sequence else 0) + (ARRAY if length else 0)
    return {"name": name, "type": {"type_id": number, "capacity": int(length or 0), "string_capacity": 0,
                                   "nested_type_name": nested}}


def referenced(name, types, found):
    for one in types[name]["fields"]:
        nested = one["type"]["nested_type_name"]
        if nested and nested not in found:
            found.add(nested)
            referenced(nested, types, found)
    return found


def hash_of(name, types):
    others = [types[one] for one in sorted(referenced(name, types, set()))]
    text = json.dumps({"type_description": types[name], "referenced_type_descriptions": others})
    return "RIHS01_" + hashlib.sha256(text.encode()).hexdigest()


class TypeHashes(unittest.TestCase):
    def test_each_is_that_of_its_type(self):
        types = descriptions((BRIDGE / "ros_types.idl").read_text())
        stated = re.findall(r"\b(\w+)_msg_dds__(\w+)__desc,\s*\"(RIHS01_\w+)\"", (BRIDGE / "message_types.h").read_text())
        self.assertEqual(len(stated), 9)
        for package, name, stated_hash in stated:
            with self.subTest(name):
                self.assertEqual(hash_of(f"{package}/msg/{name}", types), stated_hash)


if __name__ == "__main__":
    unittest.main()
