"""codec_oracle.py TOOL COUNT [SEED]: cantools as the second opinion on COUNT random frames in each
direction. Every byte must agree, and every value to half a count."""
import math
import pathlib
import random
import subprocess
import sys
from fractions import Fraction

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, subprocess.run([ROOT / "tools/can_codec/python_path"], check=True,
                                  capture_output=True, text=True).stdout.strip())
import cantools  # noqa: E402
from crccheck.crc import Crc16CcittFalse  # noqa: E402

DBC = cantools.database.load_file(ROOT / "hw_interface/socketcan/wex.dbc", strict=True)
SCALE = {(m.name, s.name): Fraction(str(s.scale)) for m in DBC.messages for s in m.signals}
DATA_ID = {m.name: m.dbc.attributes["E2EDataId"].value for m in DBC.messages}
BOUND = {m.name: "SessionBound" in m.dbc.attributes for m in DBC.messages}
mismatches = 0


def complain(text):
    global mismatches
    mismatches += 1
    if mismatches < 20:
        print("mismatch: " + text, file=sys.stderr)


def protected(message, payload, session):
    session = session if BOUND[message.name] else 0
    unsent = DATA_ID[message.name].to_bytes(2, "little") + session.to_bytes(4, "little")
    return Crc16CcittFalse.calc(payload[2:] + unsent).to_bytes(2, "little") + payload[2:]


def parse(line):
    name, frame_id, session, counter, payload, *values = line.split()
    return (name, int(frame_id, 16), int(session, 16), int(counter), bytes.fromhex(payload),
            {key: float(value) for key, value in (word.split("=") for word in values)})


def check_encoder(tool, count, seed):
    lines = subprocess.run([tool, "write", str(count), str(seed)], check=True,
                           capture_output=True, text=True).stdout.splitlines()
    if len(lines) != count:
        complain(f"{len(lines)} lines instead of {count}")
    for line in lines:
        name, frame_id, session, counter, payload, values = parse(line)
        message = DBC.get_message_by_name(name)
        raw = {key: round(Fraction(value) / SCALE[name, key]) for key, value in values.items()}
        expected = protected(message, message.encode({**raw, "Crc": 0, "Counter": counter},
                                                     scaling=False, strict=True), session)
        if frame_id != message.frame_id or payload != expected:
            complain(f"{line}\n  expected {message.frame_id:x} {expected.hex()}")
        decoded = message.decode(payload, decode_choices=False)
        for key, value in values.items():
            half_count = float(SCALE[name, key]) * 0.5
            if not abs(decoded[key] - value) <= half_count * (1 + 1e-6):
                complain(f"{name}.{key}: sent {value!r}, cantools reads {decoded[key]!r}")


def random_raw(message, generator):
    """Mostly in range; one frame in eight has one signal beyond its range."""
    raw = {}
    for signal in message.signals:
        scale = SCALE[message.name, signal.name]
        low, high = (int(Fraction(str(x)) / scale) for x in (signal.minimum, signal.maximum))
        raw[signal.name] = generator.choice((low, high, 0 if low <= 0 <= high else low,
                                             generator.randint(low, high)))
    beyond = []
    if generator.random() < 0.125:
        signal = generator.choice(message.signals[2:])
        scale = SCALE[message.name, signal.name]
        top = (1 << (signal.length - (1 if signal.is_signed else 0))) - 1
        high = int(Fraction(str(signal.maximum)) / scale)
        if high < top:
            raw[signal.name] = generator.randint(high + 1, top)
            beyond = [signal.name]
    return raw, beyond


def has_value(raw, signal):
    """Feedback and pose of a bad quality are not read, whatever stands there."""
    quality = raw.get("Quality", raw.get(signal.rsplit("_", 1)[0] + "_Quality", 0))
    return quality < 2 or signal.endswith("Quality") or signal == "SampleTimeMs"


def check_decoder(tool, count, seed):
    generator = random.Random(seed)
    sent, lines = [], []
    for _ in range(count):
        message = generator.choice(DBC.messages)
        session = generator.getrandbits(32)
        raw, beyond = random_raw(message, generator)
        payload = protected(message, message.encode(raw, scaling=False, strict=False), session)
        sent.append((message, raw, beyond))
        lines.append(f"{message.name} {message.frame_id:x} {session:x} 0 {payload.hex()}\n")
    received = subprocess.run([tool, "read"], input="".join(lines), check=True,
                              capture_output=True, text=True).stdout.splitlines()
    if len(received) != count:
        complain(f"{len(received)} lines instead of {count}")
    refused = 0
    for (message, raw, beyond), line, got in zip(sent, lines, received):
        if any(has_value(raw, name) for name in beyond):
            refused += 1
            if " refused " not in got:
                complain(f"{beyond} beyond the range was accepted: {line}")
            continue
        if " refused " in got:
            complain(f"{got}: {line}")
            continue
        name, _, _, counter, _, values = parse(got)
        if name != message.name or counter != raw["Counter"]:
            complain(f"{got}\n  for {line}")
        if set(values) != set(raw) - {"Crc", "Counter"}:
            complain(f"{name}: fields {sorted(values)}")
        for key, value in values.items():
            expected = float(raw[key] * SCALE[message.name, key])
            if value != expected and not (math.isnan(value) and not has_value(raw, key)):
                complain(f"{name}.{key}: {value!r} instead of {expected!r}")
    return refused


def main():
    tool, count = sys.argv[1], int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    check_encoder(tool, count, seed)
    refused = check_decoder(tool, count, seed)
    print(f"{2 * count} random frames compared with cantools {cantools.__version__}, of them"
          f" {refused} beyond a range and refused; {mismatches} mismatches (seed {seed})")
    return 1 if mismatches else 0


if __name__ == "__main__":
    sys.exit(main())
