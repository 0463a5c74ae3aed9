"""The ways in which code is broken: each yields mutants of one source file."""

from collections import namedtuple

# text[start:end] becomes `replacement`; `what` says so in words that outlive a shift of lines.
Mutant = namedtuple("Mutant", "path start end replacement what line repeat number")

_SWAPS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"),
    "==": ("!=",), "!=": ("==",), "&&": ("||",), "||": ("&&",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",),
    "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",), "|=": ("&=", "="),
    "<<": (">>",), "|": ("&",), "&": ("|",),
}
_CLAMPS = ("clamp", "confine")


def mutants_of(source):
    """All mutants of the file, in the order of the text, none twice."""
    found, seen = [], set()
    for start, end, replacement in sorted(_edits(source)):
        if source.text[start:end] == replacement or (start, end, replacement) in seen:
            continue
        if any(first <= start < last for first, last in source.asserted):
            continue
        seen.add((start, end, replacement))
        found.append(_described(source, start, end, replacement))
    return found


def _described(source, start, end, replacement):
    line, repeat, number = source.line_of(start)
    old = " ".join(source.text[start:end].split())
    new = " ".join(replacement.split())
    what = f"`{old}` -> `{new}`" if new else f"removed `{old}`"
    line_start = source.text.rfind("\n", 0, start) + 1
    nth = sum(t.start >= line_start and t.end <= start and t.text == source.text[start:end]
              for t in source.tokens)
    if nth:
        what += f" (occurrence {nth + 1})"
    return Mutant(source.path, start, end, replacement, what, line, repeat, number)


def _edits(source):
    for rule in (_operators, _signs, _numbers, _booleans, _conditions, _arms, _bounds, _statements,
                 _returns, _cases):
        yield from rule(source)


def _operators(source):
    for i, token in enumerate(source.tokens):
        if token.kind == "operator" and token.text in _SWAPS and source.spaced(i):
            for other in _SWAPS[token.text]:
                yield token.start, token.end, other


def _signs(source):
    """Unary minus and not are dropped, steps go the other way."""
    for i, token in enumerate(source.tokens):
        if token.text in ("++", "--"):
            yield token.start, token.end, "--" if token.text == "++" else "++"
        elif token.text in ("-", "!") and not source.text[token.end].isspace():
            yield token.start, token.end, ""


def _numbers(source):
    for i, token in enumerate(source.tokens):
        if token.kind != "number":
            continue
        for other in _other_numbers(token.text):
            yield token.start, token.end, other


def _other_numbers(text):
    digits = text.replace("'", "")
    if digits.lower().startswith("0x"):
        return [hex(int(digits, 16) - 1)]
    suffix = digits[len(digits.rstrip("uUlLfF")):]
    body = digits[:len(digits) - len(suffix)]
    if any(c in body for c in ".eE"):
        value = float(body)
        changed = [1.0] if value == 0.0 else [0.0, value * 1.01]
        return [repr(v) + suffix for v in changed]
    value = int(body)
    return [str(v) + suffix for v in ([1] if value == 0 else [value - 1, value + 1])]


def _booleans(source):
    for token in source.tokens:
        if token.text in ("true", "false"):
            yield token.start, token.end, "false" if token.text == "true" else "true"


def _conditions(source):
    """Each if and while always, never; each named condition the other way."""
    for i, token in enumerate(source.tokens):
        if token.text in ("if", "while") and source.tokens[i + 1].text == "(":
            start, end = source.tokens[i + 1].end, source.tokens[source.partner[i + 1]].start
            yield start, end, "true"
            if token.text == "if":
                yield start, end, "false"
        if token.text == "bool" and source.tokens[i + 2].text == "=" and source.in_body[i]:
            start = source.tokens[i + 3].start
            end = source.text.index(";", start)
            yield start, end, f"!({source.text[start:end]})"


def _arms(source):
    """The arms of a conditional expression change places."""
    for i, token in enumerate(source.tokens):
        if token.text != "?":
            continue
        colon = _skip_to(source, i + 1, (":",), "?")
        end = _skip_to(source, colon + 1, (";", ",", ")", "}"), None)
        first = source.text[source.tokens[i + 1].start:source.tokens[colon - 1].end]
        last = source.text[source.tokens[colon + 1].start:source.tokens[end - 1].end]
        yield (source.tokens[i + 1].start, source.tokens[end - 1].end, f"({last}) : ({first})")


def _skip_to(source, i, ends, nested):
    depth = 0
    while depth or source.tokens[i].text not in ends:
        text = source.tokens[i].text
        if text == nested:
            depth += 1
        elif depth and text in ends:
            depth -= 1
        if i in source.partner and source.partner[i] > i:
            i = source.partner[i]
        i += 1
    return i


def _bounds(source):
    """clamp(x, low, high) with its bounds swapped."""
    for i, token in enumerate(source.tokens):
        if token.text not in _CLAMPS or source.tokens[i + 1].text != "(":
            continue
        if source.in_body[i] is None:
            continue  # its definition
        commas = []
        j = i + 2
        while j < source.partner[i + 1]:
            if source.tokens[j].text == ",":
                commas.append(j)
            if j in source.partner and source.partner[j] > j:
                j = source.partner[j]
            j += 1
        start, end = source.tokens[commas[0] + 1].start, source.tokens[j].start
        low = source.text[start:source.tokens[commas[1]].start]
        high = source.text[source.tokens[commas[1] + 1].start:end]
        yield start, end, f"{high}, {low}"


def _statements(source):
    """Statements that do something are left out; declarations would only not compile."""
    for first, last in source.statements():
        head = source.tokens[first]
        if head.text in ("const", "constexpr", "using", "return", "namespace", "auto"):
            if not (head.text == "return" and last == first + 1):
                continue
        if source.tokens[first + 1].kind == "name" and head.kind == "name":
            continue  # a declaration: type and name
        yield head.start, source.tokens[last].end, ";"


def _returns(source):
    """What is returned becomes the zero of its type."""
    for first, last in source.statements():
        if source.tokens[first].text == "return" and last > first + 1:
            value = source.text[source.tokens[first + 1].start:source.tokens[last].start]
            if value not in ("true", "false", "0", "{}"):
                yield source.tokens[first + 1].start, source.tokens[last].start, "{}"


def _cases(source):
    """A label of a switch is left out."""
    for i, token in enumerate(source.tokens):
        if token.text == "case":
            j = i
            while source.tokens[j].text != ":":
                j += 1
            yield token.start, source.tokens[j].end, ""
