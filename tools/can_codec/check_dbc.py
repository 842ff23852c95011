"""What must hold of a DBC before code is made from it, and the bus load it asks for."""
from fractions import Fraction

NOMINAL_BIT_S = 1 / 500e3
DATA_BIT_S = 1 / 2e6


def raw_range(signal):
    """Raw numbers of the physical range, exactly."""
    scale = Fraction(str(signal.scale))
    return Fraction(str(signal.minimum)) / scale, Fraction(str(signal.maximum)) / scale


def attribute(owner, name, database):
    """Value of a DBC attribute as text or number, the definition's default if not set."""
    value = owner.dbc.attributes.get(name)
    definition = database.dbc.attribute_definitions[name]
    value = definition.default_value if value is None else value.value
    if definition.type_name == "ENUM" and not isinstance(value, str):
        value = definition.choices[value]
    return value


def table_names(signal):
    """Names of the raw values 0, 1, ... of an enumeration, else an empty list."""
    choices = {int(raw): str(name) for raw, name in (signal.choices or {}).items()}
    return [choices[i] for i in sorted(choices)] if 0 in choices else []


def complaints(database):
    result, ids, data_ids = [], set(), set()
    for message in database.messages:
        if message.frame_id in ids or message.is_extended_frame:
            result.append(f"id {message.frame_id:#x} is used twice or has 29 bits")
        ids.add(message.frame_id)
        data_id = attribute(message, "E2EDataId", database)
        if data_id in data_ids or data_id == 0:
            result.append(f"{message.name}: E2EDataId {data_id:#x} is missing or used twice")
        data_ids.add(data_id)
        if len(message.senders) != 1:
            result.append(f"{message.name} has {len(message.senders)} senders instead of one")
        if attribute(message, "GenMsgCycleTime", database) <= 0:
            result.append(f"{message.name} has no cycle time, so its load is unknown")
        profile = attribute(message, "E2EProfile", database)
        crc_bits, counter_bits = {"Crc16Counter8": (16, 8), "Crc8Counter4": (8, 4)}[profile]
        first = message.signals[:2]
        if [(s.name, s.start, s.length) for s in first] != [
                ("Crc", 0, crc_bits), ("Counter", crc_bits, counter_bits)]:
            result.append(f"{message.name} does not begin with Crc and Counter of {profile}")
        for signal in message.signals:
            result += [f"{message.name}.{signal.name}: {text}" for text in _signal(signal)]
    return result


def _signal(signal):
    result = []
    if signal.is_float or signal.byte_order != "little_endian" or signal.offset != 0:
        result.append("must be a little-endian integer without offset")
    if signal.is_multiplexer or signal.multiplexer_ids:
        result.append("multiplexing is not supported")
    if signal.minimum is None or signal.maximum is None or signal.minimum >= signal.maximum:
        return result + ["has no range"]
    low, high = raw_range(signal)
    top = 1 << (signal.length - 1 if signal.is_signed else signal.length)
    bottom = 1 - top if signal.is_signed else 0  # the most negative one means not available
    if low < bottom or high >= top:
        result.append(f"[{signal.minimum}, {signal.maximum}] does not fit {signal.length} bits")
    if low.denominator != 1 or high.denominator != 1:
        result.append("its range does not end on raw numbers")
    names = table_names(signal)
    if names and (low, high) != (0, len(names) - 1):
        result.append("its range is not that of its table")
    return result


def bus_load(database):
    """Share of each bus in use in the worst case of bit stuffing, and a table for a person.
    Event messages are listed but not added: while HostStop is sent, no commands are."""
    load, rows = {}, []
    for m in database.messages:
        time_s = frame_time_s(m, database)
        share = time_s / (attribute(m, "GenMsgCycleTime", database) * 1e-3)
        bus = attribute(m, "Bus", database)
        event = attribute(m, "GenMsgSendType", database) == "Event"
        load[bus] = load.get(bus, 0.0) + (0.0 if event else share)
        rows.append(f"  {bus}  {m.frame_id:#05x} {m.name:18} {m.length:3} B "
                    f"{1e6 * time_s:6.0f} us {100 * share:6.2f} %{' (at events)' if event else ''}")
    rows += [f"  bus {bus}: {100 * share:.1f} % in the worst case" for bus, share in load.items()]
    return load, "\n".join(rows)


def frame_time_s(message, database):
    n = message.length
    if not message.is_fd:
        # SOF to CRC is stuffed, CRC delimiter to intermission is not: 8 n + 47 bits and stuffing.
        return (8 * n + 47 + (34 + 8 * n - 1) // 4) * NOMINAL_BIT_S
    crc, fixed_stuff = (17, 6) if n <= 16 else (21, 7)
    nominal = 17 + 17 // 4 + 13  # SOF..BRS and its stuffing; CRC delimiter..intermission
    data = 5 + 8 * n + (5 + 8 * n) // 4 + 4 + crc + fixed_stuff  # ESI, DLC, payload, stuff count
    switched = attribute(message, "CANFD_BRS", database) == "1"
    return nominal * NOMINAL_BIT_S + data * (DATA_BIT_S if switched else NOMINAL_BIT_S)
