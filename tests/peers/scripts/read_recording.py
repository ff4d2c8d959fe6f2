"""Reads a recording with the package `mcap` and its decoder of protocol buffers: a line of JSON says what is in it."""

import json
import sys

from importlib import import_module

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory


def check_against_foxglove(descriptor):
    """Fields of Foxglove's messages have the names, numbers and types that its own package gives them."""
    if descriptor.full_name.startswith("foxglove."):
        theirs = getattr(import_module(f"foxglove_schemas_protobuf.{descriptor.name}_pb2"), descriptor.name).DESCRIPTOR
        for field in descriptor.fields:
            known = theirs.fields_by_name[field.name]
            facts = lambda one: (one.number, one.type, one.is_repeated, one.message_type and one.message_type.full_name)
            assert facts(field) == facts(known), field.full_name
    for field in descriptor.fields:
        if field.message_type:
            check_against_foxglove(field.message_type)


checked = set()

counts, frames, texts, lines, alarms, motions = {}, {}, [], set(), [], []
last = 0
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    summary = reader.get_summary()
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        assert schema.encoding == "protobuf" and decoded.DESCRIPTOR.full_name == schema.name
        if schema.name not in checked:
            check_against_foxglove(decoded.DESCRIPTOR)
            checked.add(schema.name)
        assert message.log_time >= last, "messages come in the order of their times"
        last = message.log_time
        counts[channel.topic] = counts.get(channel.topic, 0) + 1
        if schema.name == "foxglove.FrameTransforms":
            for one in decoded.transforms:
                at = (one.translation.x, one.translation.y, one.translation.z)
                turned = (one.rotation.x, one.rotation.y, one.rotation.z, one.rotation.w)
                frames.setdefault(one.child_frame_id, set()).add((at, turned))
        elif schema.name == "foxglove.Log":
            (alarms if decoded.level == 4 else texts).append(decoded.message)
        elif schema.name == "arl2rs.v1.Channel":
            lines.add(decoded.motion_line)
        elif schema.name == "arl2rs.v1.Motion":
            motions.append([decoded.line, decoded.kind, round(decoded.start, 3), round(decoded.duration, 3)])

print(
    json.dumps(
        {
            "chunks": len(summary.chunk_indexes),
            "counted": {summary.channels[at].topic: count for at, count in summary.statistics.channel_message_counts.items()},
            "counts": counts,
            "moving": sorted(name for name, places in frames.items() if len(places) > 10),
            "texts": texts,
            "alarms": alarms,
            "lines": sorted(lines),
            "motions": motions,
            "seconds": last / 1e9,
        }
    )
)
