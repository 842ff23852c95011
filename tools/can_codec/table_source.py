"""signal_table.{hpp,cpp}: what the codec must know of every signal and cannot read from C code."""
from fractions import Fraction

from cantools.database.can.c_source import camel_to_snake_case

from check_dbc import attribute, raw_range, table_names
from dbc_text import NO_POSITION_LIMIT

NOTE = "// Generated from wex.dbc by tools/can_codec/generate. Do not edit.\n"


def table_header(database, dbc_hash):
    count = len(database.messages)
    widest = max(len(message.signals) for message in database.messages)
    return f"""{NOTE}#pragma once

#include <array>
#include <cstdint>

#include "hw_interface/socketcan/signal_row.hpp"

namespace wex::can::generated {{

/// First 32 bits of the SHA-256 of wex.dbc.
inline constexpr std::uint32_t kDbcHash = 0x{dbc_hash};

/// Most signals in a message.
inline constexpr int kMaxSignals = {widest};

/// All messages by ascending id.
extern const std::array<MessageRow, {count}> kMessages;

}}  // namespace wex::can::generated
"""


def table_source(database):
    parts = [NOTE, """#include "hw_interface/socketcan/generated/signal_table.hpp"

#include <limits>

#include "hw_interface/socketcan/generated/wex_dbc.h"

namespace wex::can::generated {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

"""]
    tables = {tuple(table_names(s)) for m in database.messages for s in m.signals} - {()}
    for names in sorted(tables):
        texts = ", ".join(f'"{name}"' for name in names)
        parts.append(f"constexpr std::array<const char*, {len(names)}> {_table(names)}{{{texts}}};\n")
    for message in database.messages:
        parts.append(_message(message, database))
    parts.append("}  // namespace\n\n"
                 f"constinit const std::array<MessageRow, {len(database.messages)}> kMessages{{{{\n")
    for m in sorted(database.messages, key=lambda message: message.frame_id):
        kind = m.name.rstrip("ABCDEFGHIJKLMNOPQRSTUVWXYZ") if m.name.startswith("Zone") else m.name
        zone = m.frame_id & 0xF if m.name.startswith("Zone") else -1
        joints = {attribute(s, "JointName", database) for s in m.signals} - {""}
        profile = attribute(m, "E2EProfile", database)
        bound = attribute(m, "SessionBound", database) == "Yes"
        parts.append(
            f"    {{0x{m.frame_id:03X}, MessageKind::k{kind}, {zone}, \"{m.name}\", "
            f"\"{m.senders[0]}\", {m.length}, {_bool(m.is_fd)},\n"
            f"     E2eProfile::k{profile}, 0x{attribute(m, 'E2EDataId', database):04X}, "
            f"{_bool(bound)}, {attribute(m, 'GenMsgCycleTime', database)}, "
            f"{attribute(m, 'TimeoutMs', database)}, {len(joints)},\n"
            f"     k{m.name}, pack_{camel_to_snake_case(m.name)}, "
            f"unpack_{camel_to_snake_case(m.name)}}},\n")
    parts.append("}};\n\n}  // namespace wex::can::generated\n")
    return "".join(parts)


def _message(message, database):
    snake = camel_to_snake_case(message.name)
    rows = "".join(_row(signal, database) for signal in message.signals)
    struct = f"wex_dbc_{snake}_t"
    fields = [camel_to_snake_case(signal.name) for signal in message.signals]
    to_struct = "".join(f"  m.{name} = static_cast<decltype(m.{name})>(raw[{i}]);\n"
                        for i, name in enumerate(fields))
    from_struct = "".join(f"  raw[{i}] = m.{name};\n" for i, name in enumerate(fields))
    return f"""
constexpr std::array<SignalRow, {len(fields)}> k{message.name}{{{{
{rows}}}}};

void pack_{snake}(const std::int64_t* raw, std::uint8_t* bytes) noexcept {{
  {struct} m;
{to_struct}  wex_dbc_{snake}_pack(bytes, &m, {message.length});
}}

void unpack_{snake}(const std::uint8_t* bytes, std::int64_t* raw) noexcept {{
  {struct} m;
  wex_dbc_{snake}_unpack(&m, bytes, {message.length});
{from_struct}}}

"""


def _row(signal, database):
    """Scale as a quotient of whole numbers: raw * numerator / denominator rounds once."""
    scale = Fraction(str(signal.scale))
    low, high = raw_range(signal)
    names = table_names(signal)
    limits = [_limit(attribute(signal, name, database)) for name in
              ("RateLimit", "AccelerationLimit", "PositionLower", "PositionUpper")]
    return (f"    {{\"{signal.name}\", \"{signal.unit or ''}\", "
            f"\"{attribute(signal, 'JointName', database)}\", "
            f"{scale.numerator}.0, {scale.denominator}.0, {_number(signal.minimum)}, "
            f"{_number(signal.maximum)}, {low}, {high},\n"
            f"     {_bool(signal.is_signed)}, {-(1 << (signal.length - 1))}, "
            f"{_table(names) if names else '{}'}, {', '.join(limits)}}},\n")


def _table(names):
    return "k" + "".join(names) + "Names"


def _bool(value):
    return "true" if value else "false"


def _number(value):
    return repr(float(value))


def _limit(value):
    if abs(value) >= NO_POSITION_LIMIT:
        return "kInfinity" if value > 0 else "-kInfinity"
    return _number(value)
