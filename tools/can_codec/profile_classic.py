"""The classic profile: two buses at 500 kbit/s, 8-byte frames, CRC-8 0x2F and a 4-bit counter.

It needs one controller with a port on each bus. Three joints share a frame; rates come back at
50 Hz, and what one FD frame carries is split where 8 bytes are too few."""
from decimal import ROUND_UP, Decimal

from dbc_text import Message, integer, measure, table
from profile_fd import MODES, PI, QUALITIES
from profile_fd import NODES  # noqa: F401 (the same participants)
from profile_fd import position_range

GROUPS = [  # bus, joints
    (1, ["LF_HAA", "LF_HFE", "LF_STEER"]),
    (1, ["RF_HAA", "RF_HFE", "RF_STEER"]),
    (1, ["LH_HAA", "LH_HFE", "LH_STEER"]),
    (1, ["RH_HAA", "RH_HFE", "RH_STEER"]),
    (2, ["LF_WHEEL", "RF_WHEEL", "LH_WHEEL"]),
    (2, ["RH_WHEEL", "LH_CLAW", "RH_CLAW"]),
    (2, ["TURN", "BOOM", "DIPPER"]),
    (2, ["TELE", "EE_PITCH"]),
    (2, ["EE_ROLL", "EE_YAW"]),
]
COMMENT = ("Classic CAN profile of wex: two buses at 500 kbit/s (attribute Bus). Byte 0 of every"
           " frame: CRC-8 0x2F over the rest of the payload, E2EDataId and session (0 unless"
           " SessionBound), both low byte first; low half of byte 1: counter. Unlisted bits are"
           " sent as 0.")
CLASSIC = {"fd": False, "profile": "Crc8Counter4"}
HOST_TO_MACHINE = {"sender": "HOST", "receivers": ["MACHINE"]}
MACHINE_TO_HOST = {"sender": "MACHINE", "receivers": ["HOST"]}


def check():
    return [integer("Crc", 0, 8), integer("Counter", 8, 4)]


def group_messages(number, bus, joints):
    command, position, rate, pressure = check(), check(), check(), check()
    for i, joint in enumerate(joints):
        name = {"JointName": joint.name}
        limits = {} if joint.continuous else {"PositionLower": joint.lower,
                                              "PositionUpper": joint.upper}
        command += [measure(f"{joint.name}_Rate", 16 + 16 * i, 16, "0.0001", -joint.rate,
                            joint.rate, joint.unit + "/s",
                            attributes={**name, "RateLimit": joint.rate,
                                        "AccelerationLimit": joint.acceleration}),
                    integer(f"{joint.name}_Active", 12 + i, 1, attributes=name)]
        low, high = position_range(joint)
        coarse = {"-" + PI: "-3.1416", PI: "3.1416"}
        position += [measure(f"{joint.name}_Position", 16 + 16 * i, 16, "0.0001",
                             coarse.get(low, round_out(low)), coarse.get(high, round_out(high)),
                             joint.unit, attributes={**name, **limits}),
                     table(f"{joint.name}_Invalid", 12 + i, 1, ["Ok", "Invalid"],
                           attributes=name)]
        rate.append(measure(f"{joint.name}_Rate", 16 + 16 * i, 16, "0.0002", -6, 6,
                            joint.unit + "/s", attributes=name))
        pressure.append(measure(f"{joint.name}_LoadPressure", 16 + 16 * i, 16, "2000", -60000000,
                                60000000, "Pa", attributes=name, comment="A minus B"))
    label = str(number)
    return [
        Message(0x080 + number, "GroupCommand" + label, 8, **HOST_TO_MACHINE, cycle_ms=10,
                timeout_ms=50, signals=command, bus=bus, session_bound=True, **CLASSIC),
        Message(0x100 + number, "GroupPosition" + label, 8, **MACHINE_TO_HOST, cycle_ms=10,
                timeout_ms=50, signals=position, bus=bus, **CLASSIC),
        Message(0x120 + number, "GroupRate" + label, 8, **MACHINE_TO_HOST, cycle_ms=20,
                timeout_ms=100, signals=rate, bus=bus, **CLASSIC),
        Message(0x300 + number, "GroupPressure" + label, 8, **MACHINE_TO_HOST, cycle_ms=50,
                timeout_ms=250, signals=pressure, bus=bus, **CLASSIC),
    ]


def round_out(value):
    """To the frame's 1e-4, never narrower."""
    return Decimal(value).quantize(Decimal("0.0001"), rounding=ROUND_UP)


def bus_messages(bus):
    label = "AB"[bus - 1]
    stamp = check() + [integer("SampleTimeMs", 16, 32, unit="ms")]
    command = check() + [integer("EchoTimeMs", 16, 32, unit="ms"),
                         integer("ValidForMs", 48, 8, unit="ms")]
    return [
        Message(0x070 + bus, "CommandStamp" + label, 8, **HOST_TO_MACHINE, cycle_ms=10,
                timeout_ms=50, signals=command, bus=bus, session_bound=True, **CLASSIC,
                comment="Sent after the bus's GroupCommand frames and stands for all of them."),
        Message(0x0F0 + bus, "FeedbackStamp" + label, 8, **MACHINE_TO_HOST, cycle_ms=10,
                timeout_ms=50, signals=stamp, bus=bus, **CLASSIC,
                comment="Sent before the bus's GroupPosition frames: the time of them."),
    ]


def system_messages():
    result = [
        Message(0x010, "EStopState", 8, "SAFETY", ["HOST", "MACHINE", "TERMINAL"], 10, 50,
                check() + [integer("ChainOpen", 12, 1), integer("Cause", 16, 8)], **CLASSIC,
                send_type="CyclicAndOnChange"),
        Message(0x020, "HostStop", 8, "HOST", ["MACHINE", "TERMINAL"], 10, 0,
                check() + [integer("Active", 12, 1), integer("Cause", 16, 8)], **CLASSIC,
                send_type="Event"),
        Message(0x030, "OperatorCommand", 8, "TERMINAL", ["HOST", "MACHINE"], 50, 0,
                check() + [table("Action", 12, 4, ["None", "Stop", "Reset"])], **CLASSIC,
                send_type="Event", bus=2),
        Message(0x040, "HostHeartbeat", 8, "HOST", ["MACHINE", "TERMINAL"], 20, 100,
                check() + [table("Request", 12, 4, ["None", "Enable", "Disable"]),
                           integer("Session", 16, 32), integer("Nonce", 48, 16)], **CLASSIC),
        Message(0x041, "HostHandshake", 8, "HOST", ["MACHINE", "TERMINAL"], 20, 100,
                check() + [integer("ChallengeEcho", 16, 32), integer("DbcHash", 48, 16)],
                **CLASSIC, comment="DbcHash: first 16 bits of the SHA-256 of this file"),
        Message(0x200, "MachineStatus", 8, "MACHINE", ["HOST", "TERMINAL"], 50, 250,
                check() + [table("Mode", 12, 4, MODES), integer("FaultBits", 16, 16),
                           integer("RejectedFrames", 32, 16)], **CLASSIC),
        Message(0x201, "MachineHandshake", 8, "MACHINE", ["HOST", "TERMINAL"], 50, 250,
                check() + [integer("Challenge", 16, 32), integer("DbcHash", 48, 16)], **CLASSIC),
        Message(0x202, "MachineSession", 8, "MACHINE", ["HOST", "TERMINAL"], 50, 250,
                check() + [integer("Session", 16, 32)], **CLASSIC),
    ]
    for number, (what, scale, limit, unit) in enumerate(
            (("AngularVelocity", "0.0005", 10, "rad/s"), ("Acceleration", "0.005", 100, "m/s^2"))):
        result.append(Message(
            0x180 + number, "Imu" + what, 8, **MACHINE_TO_HOST, cycle_ms=20, timeout_ms=100,
            signals=check() + [measure(what + a, 16 + 16 * i, 16, scale, -limit, limit, unit)
                               for i, a in enumerate("XYZ")], **CLASSIC))
    pose = {"sender": "LOCALISATION", "receivers": ["HOST", "MACHINE"], "cycle_ms": 20,
            "timeout_ms": 100, "bus": 2, **CLASSIC}
    for number, (axis, low, high) in enumerate((("X", -20000000, 20000000),
                                                ("Y", -20000000, 20000000), ("Z", -1000, 10000))):
        extra = [table("Quality", 56, 4, QUALITIES)] if axis == "Z" else []
        result.append(Message(0x188 + number, "BasePosition" + axis, 8, **pose, signals=check() + [
            measure("Position" + axis, 16, 40, "0.0001", low, high, "m")] + extra))
    result.append(Message(0x18B, "BaseAttitude", 8, **pose, signals=check() + [
        measure(a, 16 + 16 * i, 16, "0.0001", "-3.1416", "3.1416", "rad")
        for i, a in enumerate(("Yaw", "Pitch", "Roll"))]))
    result.append(Message(0x18C, "BaseVelocity", 8, **pose, signals=check() + [
        measure("Velocity" + a, 16 + 16 * i, 16, "0.001", -20, 20, "m/s")
        for i, a in enumerate("XYZ")]))
    return result


def messages(joints):
    result = system_messages() + bus_messages(1) + bus_messages(2)
    for number, (bus, names) in enumerate(GROUPS):
        result += group_messages(number, bus, [joints[name] for name in names])
    return sorted(result, key=lambda message: message.id)
