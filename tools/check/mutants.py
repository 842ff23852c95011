"""The changes that mutate_safety_files makes: one operator, constant, condition or statement each."""
import re

SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||",
         "||": "&&", "+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "^": "|", "|": "&", "&": "|",
         "+=": "-=", "-=": "+=", "<<": ">>", ">>": "<<"}
WORDS = {"true": "false", "false": "true", "std::min": "std::max", "std::max": "std::min",
         "std::all_of": "std::any_of", "continue;": ";", "return;": ";", "break;": ";"}
# clang-format puts spaces around binary operators only.
OPERATOR = re.compile(r"(?<= )(?:" + "|".join(
    re.escape(op) for op in sorted(SWAPS, key=len, reverse=True)) + r")(?= |$)")
WORD = re.compile(r"(?<![\w:])(?:" + "|".join(map(re.escape, WORDS)) + r")(?![\w:])")
INTEGER = re.compile(r"(?<![\w.'\"])(?<!\de-)\d+(?:'\d+)*(?![\w.'])")
REAL = re.compile(r"(?<![\w.'])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")
CONDITION = re.compile(r"(?<=\bif \()(.*)(?=\) (?:\{|[\w+*-]))")
NEGATION = re.compile(r"(?<=[( ])!(?=[\w(])")
STEP = re.compile(r"\+\+|--")
STATEMENT = re.compile(r"^(\s+|.*\) )((?!return\b|break\b|continue\b|using\b|throw\b)"
                       r"[\w.>*\[\]():+-]+(?:\(.*\)| [-+|^&]?= .*|\+\+)|(?:\+\+|--)[\w.>-]+);$")
DIRECTIVE = ("#", "namespace", "static_assert", "template", "using")


def replaced(code, match, new):
    return code[:match.start()] + new + code[match.end():]


def variants(code):
    """Every change of one line of code."""
    for match in OPERATOR.finditer(code):
        yield replaced(code, match, SWAPS[match.group()])
    for match in WORD.finditer(code):
        yield replaced(code, match, WORDS[match.group()])
    for match in INTEGER.finditer(code):
        for change in (1, -1):
            yield replaced(code, match, str(int(match.group().replace("'", "")) + change))
    for match in REAL.finditer(code):
        if INTEGER.fullmatch(match.group()):
            continue
        yield replaced(code, match, f"({match.group()} + 1.0)")
        if float(match.group()) == 0.0:
            continue
        # Limits and times are small numbers: a little more or less must be noticed as well.
        yield replaced(code, match, f"(1.25 * {match.group()})")
        yield replaced(code, match, f"(0.8 * {match.group()})")
    for match in CONDITION.finditer(code):
        yield replaced(code, match, f"!({match.group()})")
    for match in NEGATION.finditer(code):
        yield replaced(code, match, "")
    for match in STEP.finditer(code):
        yield replaced(code, match, "--" if match.group() == "++" else "++")
    match = STATEMENT.match(code)
    if match:
        yield code[:match.start(2)] + ";"


def mutants_of(text):
    """(index of the line, old line, new line) of every change; comments, strings and directives are
    left alone, and two changes that give the same line are one."""
    for index, line in enumerate(text.splitlines()):
        code = line.split("//")[0].rstrip()
        if not code or code.lstrip().startswith(DIRECTIVE) or '"' in code:
            continue
        seen = {code}
        for new in variants(code):
            if new not in seen:
                seen.add(new)
                yield index, code, new
