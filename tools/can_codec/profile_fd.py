"""The default profile: CAN FD, one frame per zone and direction, CRC-16 and 8-bit counter."""
from decimal import Decimal

from dbc_text import Message, integer, measure, table

# Joints by zone, in the order of their places in the frames (hw_interface/socketcan/messages.hpp).
ZONES = {
    "LF": ["LF_HAA", "LF_HFE", "LF_STEER", "LF_WHEEL"],
    "RF": ["RF_HAA", "RF_HFE", "RF_STEER", "RF_WHEEL"],
    "LH": ["LH_HAA", "LH_HFE", "LH_STEER", "LH_WHEEL", "LH_CLAW"],
    "RH": ["RH_HAA", "RH_HFE", "RH_STEER", "RH_WHEEL", "RH_CLAW"],
    "ARM": ["TURN", "BOOM", "DIPPER", "TELE"],
    "TOOL": ["EE_PITCH", "EE_ROLL", "EE_YAW"],
}
NODES = {
    "HOST": "Computer that plans and commands",
    "TERMINAL": "Operator's terminal or panel",
    "MACHINE": "Electronics of all zones; the authority over enabling",
    "SAFETY": "Safety controller, reports the hardwired emergency-stop chain",
    "LOCALISATION": "Unit that knows where the machine stands on the map",
}
COMMENT = ("CAN FD profile of wex, 500 kbit/s and 2 Mbit/s. Bytes 0-1 of every frame: CRC-16 0x1021"
           " over the rest of the payload, E2EDataId and session (0 unless SessionBound), both"
           " low byte first; byte 2: counter. Unlisted bits are sent as 0.")
MODES = ["Init", "Ready", "Enabling", "Enabled", "Hold", "Fault", "EStop"]
QUALITIES = ["Ok", "Stale", "Invalid", "NotAvailable"]
PI = "3.141593"
BEYOND_STOP = Decimal("0.25")  # a sensor sees a little more than the joint's end stops


def check():
    return [integer("Crc", 0, 16), integer("Counter", 16, 8)]


def position_range(joint):
    if joint.continuous:
        return "-" + PI, PI
    return joint.lower - BEYOND_STOP, joint.upper + BEYOND_STOP


def zone_messages(zone, label, joints):
    host_to_machine = {"sender": "HOST", "receivers": ["MACHINE"]}
    machine_to_host = {"sender": "MACHINE", "receivers": ["HOST"]}
    command, feedback, pressure = check(), check(), check()
    command += [integer("ValidForMs", 24, 8, unit="ms", comment="Counts from EchoTimeMs"),
                integer("EchoTimeMs", 32, 32, unit="ms",
                        comment="SampleTimeMs of the newest feedback used")]
    feedback += [integer("SampleTimeMs", 32, 32, unit="ms", comment="Machine time, wraps")]
    for i, joint in enumerate(joints):
        name = {"JointName": joint.name}
        command += [
            measure(f"{joint.name}_Rate", 64 + 16 * i, 16, "0.0001", -joint.rate, joint.rate,
                    joint.unit + "/s",
                    attributes={**name, "RateLimit": joint.rate,
                                "AccelerationLimit": joint.acceleration}),
            integer(f"{joint.name}_Active", 144 + i, 1, comment="0: the joint holds",
                    attributes=name)]
        limits = {} if joint.continuous else {"PositionLower": joint.lower,
                                              "PositionUpper": joint.upper}
        feedback += [
            table(f"{joint.name}_Quality", 64 + 2 * i, 2, QUALITIES, attributes=name),
            measure(f"{joint.name}_Position", 80 + 32 * i, 32, "0.000001", *position_range(joint),
                    joint.unit, attributes={**name, **limits}),
            measure(f"{joint.name}_Rate", 240 + 16 * i, 16, "0.0002", -6, 6, joint.unit + "/s",
                    attributes=name),
            measure(f"{joint.name}_Spool", 320 + 12 * i, 12, "0.0005", -1, 1, "",
                    attributes=name)]
        pressure += [
            measure(f"{joint.name}_Pressure{side}", 32 + 32 * i + 16 * k, 16, "2000", -100000,
                    60000000, "Pa", attributes=name) for k, side in enumerate("AB")]
    status = check() + [
        table("Mode", 24, 4, MODES), integer("FaultBits", 32, 16),
        integer("LastAcceptedCounter", 48, 8), integer("RejectedFrames", 64, 16),
        integer("Challenge", 96, 32, comment="0: none pending"),
        integer("Session", 128, 32, comment="0: no session"),
        integer("DbcHash", 160, 32, comment="First 32 bits of the SHA-256 of this file")]
    return [
        Message(0x080 + zone, "ZoneCommand" + label, 24, **host_to_machine, cycle_ms=10,
                timeout_ms=50, signals=command, session_bound=True,
                comment="Wanted joint rates. Late or missing: the machine holds."),
        Message(0x100 + zone, "ZoneFeedback" + label, 48, **machine_to_host, cycle_ms=10,
                timeout_ms=50, signals=feedback,
                comment="One consistent sample of the zone. Continuous joints wrap at +-pi."),
        Message(0x300 + zone, "ZonePressure" + label, 24, **machine_to_host, cycle_ms=20,
                timeout_ms=200, signals=pressure, comment="Cylinder or motor pressures."),
        Message(0x200 + zone, "ZoneStatus" + label, 24, "MACHINE", ["HOST", "TERMINAL"],
                cycle_ms=50, timeout_ms=250, signals=status, send_type="CyclicAndOnChange",
                comment="Mode of the electronics and their side of the enable handshake."),
    ]


def system_messages():
    xyz = "XYZ"
    imu = check() + [integer("SampleTimeMs", 32, 32, unit="ms")]
    imu += [measure(f"AngularVelocity{a}", 64 + 32 * i, 32, "0.000001", -10, 10, "rad/s",
                    comment="World frame") for i, a in enumerate(xyz)]
    imu += [measure(f"Acceleration{a}", 160 + 32 * i, 32, "0.00001", -100, 100, "m/s^2",
                    comment="Base frame") for i, a in enumerate(xyz)]
    pose = check() + [table("Quality", 24, 4, QUALITIES),
                      integer("SampleTimeMs", 32, 32, unit="ms")]
    pose += [measure(f"Position{a}", 64 + 40 * i, 40, "0.0001", low, high, "m",
                     comment="Base origin in the map file's own frame")
             for i, (a, low, high) in enumerate(zip(xyz, (-20000000, -20000000, -1000),
                                                    (20000000, 20000000, 10000)))]
    pose += [measure(a, 192 + 32 * i, 32, "0.000001", "-" + PI, PI, "rad")
             for i, a in enumerate(("Yaw", "Pitch", "Roll"))]
    pose += [measure(f"Velocity{a}", 288 + 32 * i, 32, "0.000001", -20, 20, "m/s",
                     comment="World frame") for i, a in enumerate(xyz)]
    everyone = ["HOST", "MACHINE", "TERMINAL"]
    return [
        Message(0x010, "EStopState", 8, "SAFETY", everyone, 10, 50,
                check() + [integer("ChainOpen", 24, 1), integer("Cause", 32, 8)],
                send_type="CyclicAndOnChange",
                comment="Reports the hardwired chain; CAN is never the only stop path."),
        Message(0x020, "HostStop", 8, "HOST", ["MACHINE", "TERMINAL"], 10, 0,
                check() + [integer("Active", 24, 1), integer("Cause", 32, 8)], send_type="Event",
                comment="Software stop: three at the event, then cyclic while active."),
        Message(0x030, "OperatorCommand", 8, "TERMINAL", ["HOST", "MACHINE"], 50, 0,
                check() + [table("Action", 24, 4, ["None", "Stop", "Reset"])], send_type="Event",
                comment="An action counts on its rising edge."),
        Message(0x040, "HostHeartbeat", 24, "HOST", ["MACHINE", "TERMINAL"], 20, 100,
                check() + [table("Request", 24, 4, ["None", "Enable", "Disable"]),
                           integer("Session", 32, 32), integer("Nonce", 64, 16),
                           integer("ChallengeEcho", 96, 32),
                           integer("DbcHash", 128, 32,
                                   comment="First 32 bits of the SHA-256 of this file")],
                comment="The host lives; its side of the enable handshake."),
        Message(0x180, "Imu", 32, "MACHINE", ["HOST"], 10, 50, imu,
                comment="Rates in the world frame, acceleration in the base frame."),
        Message(0x188, "BasePose", 48, "LOCALISATION", ["HOST", "MACHINE"], 10, 50, pose,
                comment="Without it the machine is not enabled."),
        Message(0x7F0, "LockStep", 8, "HOST", ["MACHINE"], 10, 0,
                check() + [integer("RunUntilMs", 32, 32, unit="ms")], send_type="Event",
                comment="Simulated machines only: lets their clock run to this time."),
    ]


def messages(joints):
    result = system_messages()
    for zone, (label, names) in enumerate(ZONES.items()):
        result += zone_messages(zone, label, [joints[name] for name in names])
    return sorted(result, key=lambda message: message.id)
