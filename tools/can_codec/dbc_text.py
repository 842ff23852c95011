"""Messages and signals as plain data, and the DBC text of them. No third-party module."""
from dataclasses import dataclass, field
from decimal import Decimal

NO_POSITION_LIMIT = 1000000000  # PositionLower/Upper of a joint that turns without end
FRAME_FORMATS = ["StandardCAN", "ExtendedCAN"] + [f"reserved{i}" for i in range(2, 14)] + [
    "StandardCAN_FD", "ExtendedCAN_FD"]
PROFILES = ["None", "Crc16Counter8", "Crc8Counter4"]
SEND_TYPES = ["Cyclic", "CyclicAndOnChange", "Event"]


@dataclass
class Signal:
    name: str
    start: int  # bit, little-endian
    bits: int
    signed: bool = False
    scale: str = "1"
    low: Decimal = Decimal(0)
    high: Decimal = Decimal(0)
    unit: str = ""
    choices: list = field(default_factory=list)  # names of the raw values 0, 1, 2 ...
    comment: str = ""
    attributes: dict = field(default_factory=dict)


@dataclass
class Message:
    id: int
    name: str
    length: int
    sender: str
    receivers: list
    cycle_ms: int
    timeout_ms: int
    signals: list
    comment: str = ""
    fd: bool = True
    profile: str = "Crc16Counter8"
    send_type: str = "Cyclic"
    session_bound: bool = False
    bus: int = 1


def integer(name, start, bits, low=0, high=None, **more):
    """Unsigned number; all raw values are allowed unless `high` says otherwise."""
    high = (1 << bits) - 1 if high is None else high
    return Signal(name, start, bits, low=Decimal(low), high=Decimal(high), **more)


def table(name, start, bits, choices, **more):
    """Unsigned number whose only allowed raw values are those of the table."""
    return integer(name, start, bits, high=len(choices) - 1, choices=choices, **more)


def measure(name, start, bits, scale, low, high, unit, **more):
    """Signed physical value; the most negative raw value means 'not available'."""
    return Signal(name, start, bits, True, scale, Decimal(low), Decimal(high), unit, **more)


def plain(number):
    text = f"{Decimal(number):f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def attribute_definitions():
    def enum(names):
        return "ENUM " + ",".join(f'"{name}"' for name in names)

    return [
        ("", "BusType", "STRING", '"CAN"'),
        ("", "DBName", "STRING", '""'),
        ("", "Baudrate", "INT 0 1000000", 500000),
        ("", "BaudrateCANFD", "INT 0 16000000", 2000000),
        ("BO_", "VFrameFormat", enum(FRAME_FORMATS), '"StandardCAN"'),
        ("BO_", "CANFD_BRS", enum(["0", "1"]), '"0"'),
        ("BO_", "GenMsgCycleTime", "INT 0 60000", 0),
        ("BO_", "GenMsgSendType", enum(SEND_TYPES), '"Cyclic"'),
        ("BO_", "E2EProfile", enum(PROFILES), '"None"'),
        ("BO_", "E2EDataId", "INT 0 65535", 0),
        ("BO_", "SessionBound", enum(["No", "Yes"]), '"No"'),
        ("BO_", "TimeoutMs", "INT 0 60000", 0),
        ("BO_", "Bus", "INT 1 2", 1),
        ("SG_", "GenSigStartValue", "FLOAT -1E+12 1E+12", 0),
        ("SG_", "JointName", "STRING", '""'),
        ("SG_", "RateLimit", "FLOAT 0 100", 0),
        ("SG_", "AccelerationLimit", "FLOAT 0 100", 0),
        ("SG_", "PositionLower", "FLOAT -1E+09 1E+09", -NO_POSITION_LIMIT),
        ("SG_", "PositionUpper", "FLOAT -1E+09 1E+09", NO_POSITION_LIMIT),
    ]


def dbc_text(name, comment, nodes, messages):
    lines = ['VERSION ""', "", "NS_ :", "", "BS_:", "", "BU_: " + " ".join(nodes), ""]
    for message in messages:
        lines += ["", f"BO_ {message.id} {message.name}: {message.length} {message.sender}"]
        for s in message.signals:
            lines.append(
                f" SG_ {s.name} : {s.start}|{s.bits}@1{'-' if s.signed else '+'} ({s.scale},0)"
                f" [{plain(s.low)}|{plain(s.high)}] \"{s.unit}\" {','.join(message.receivers)}")
    lines += ["", "", f'CM_ "{comment}";']
    lines += [f'CM_ BU_ {node} "{text}";' for node, text in nodes.items()]
    for message in messages:
        lines.append(f'CM_ BO_ {message.id} "{message.comment}";')
        lines += [f'CM_ SG_ {message.id} {s.name} "{s.comment}";'
                  for s in message.signals if s.comment]
    lines.append("")
    lines += [f'BA_DEF_ {kind + " " if kind else ""} "{attribute}" {type_};'.replace("  ", " ")
              for kind, attribute, type_, _ in attribute_definitions()]
    lines += [f'BA_DEF_DEF_ "{attribute}" {default};'
              for _, attribute, _, default in attribute_definitions()]
    fd = any(message.fd for message in messages)
    lines += [f'BA_ "BusType" "{"CAN FD" if fd else "CAN"}";', f'BA_ "DBName" "{name}";']
    for m in messages:
        lines += _message_attributes(m)
    for m in messages:
        for s in m.signals:
            lines += _signal_attributes(m, s)
    lines.append("")
    for m in messages:
        for s in m.signals:
            if s.choices:
                pairs = " ".join(f'{i} "{choice}"' for i, choice in enumerate(s.choices))
                lines.append(f"VAL_ {m.id} {s.name} {pairs} ;")
            elif s.signed:
                lines.append(f'VAL_ {m.id} {s.name} {not_available(s)} "NotAvailable" ;')
    return "\n".join(lines) + "\n"


def not_available(signal):
    return -(1 << (signal.bits - 1))


def _message_attributes(m):
    values = [("VFrameFormat", FRAME_FORMATS.index("StandardCAN_FD") if m.fd else 0),
              ("CANFD_BRS", 1 if m.fd else 0),
              ("GenMsgCycleTime", m.cycle_ms),
              ("GenMsgSendType", SEND_TYPES.index(m.send_type)),
              ("E2EProfile", PROFILES.index(m.profile)),
              ("E2EDataId", data_id(m)),
              ("SessionBound", 1 if m.session_bound else 0),
              ("TimeoutMs", m.timeout_ms),
              ("Bus", m.bus)]
    defaults = {"CANFD_BRS": 0, "GenMsgSendType": 0, "SessionBound": 0, "Bus": 1}
    return [f'BA_ "{name}" BO_ {m.id} {value};' for name, value in values
            if defaults.get(name) != value]


def _signal_attributes(m, s):
    values = {"GenSigStartValue": not_available(s)} if s.signed else {}
    lines = []
    for name, value in {**values, **s.attributes}.items():
        text = f'"{value}"' if name == "JointName" else plain(value)
        lines.append(f'BA_ "{name}" SG_ {m.id} {s.name} {text};')
    return lines


def data_id(message):
    """Not sent, but in the checksum: the same bytes under another id are not accepted."""
    return 0x5700 + message.id
