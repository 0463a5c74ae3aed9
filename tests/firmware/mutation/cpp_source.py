"""C++ source as tokens: enough of the language to break code in chosen places.

It relies on the house's clang-format: a binary operator has spaces around it, a template's angle
brackets and a unary sign have none.
"""

import re
from collections import namedtuple

# kind: name, number, text (string or character), operator; start and end are offsets in the file.
Token = namedtuple("Token", "kind text start end")

_TOKEN = re.compile(
    r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/|\#[^\n]*)
      | (?P<text>"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])')
      | (?P<number>(?:0[xX][0-9a-fA-F']+|(?:\d[\d']*)?\.?\d[\d']*(?:[eE][+-]?\d+)?\.?)[a-zA-Z]*)
      | (?P<name>[A-Za-z_]\w*)
      | (?P<operator><=>|<<=|>>=|->|::|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)""",
    re.VERBOSE | re.DOTALL,
)

_OPEN = {"(": ")", "[": "]", "{": "}"}


def tokens_of(text):
    found = []
    for match in _TOKEN.finditer(text):
        if match.lastgroup != "skip":
            found.append(Token(match.lastgroup, match.group(), match.start(), match.end()))
    return found


class Source:
    """One file: its text, tokens, partners of brackets, and what kind of place each token is in."""

    def __init__(self, path, text):
        self.path = path
        self.text = text
        self.tokens = tokens_of(text)
        self.partner = self._pair_brackets()
        self.in_body = self._find_bodies()
        self.asserted = self._find_assertions()

    def _pair_brackets(self):
        partner, waiting = {}, []
        for i, token in enumerate(self.tokens):
            if token.kind == "operator" and token.text in _OPEN:
                waiting.append(i)
            elif token.kind == "operator" and token.text in _OPEN.values():
                opened = waiting.pop()
                partner[opened], partner[i] = i, opened
        return partner

    def _is_body(self, i):
        """Whether the brace at i opens statements: what stands before it is a parameter list or a
        condition (perhaps with const, noexcept or an initialiser list), else, do."""
        before = self.tokens[i - 1]
        if before.text in ("else", "do"):
            return True
        j = i - 1
        while self.tokens[j].text in ("const", "noexcept", "override", "mutable"):
            j -= 1
        if self.tokens[j].text == ")":
            return True
        # A constructor's last member initialiser: ") : a_(1), b_{2} {" ends in } or ).
        return self.tokens[j].text == "}" and self.tokens[self.partner[j] - 1].kind == "name" and (
            self.tokens[self.partner[j] - 2].text in (",", ":"))

    def _find_bodies(self):
        """For each token: the index of the innermost brace of statements around it, or None."""
        innermost, around = [], []
        for i, token in enumerate(self.tokens):
            if token.text == "{" and token.kind == "operator":
                around.append(i if self._is_body(i) else None)
            innermost.append(around[-1] if around else None)
            if token.text == "}" and token.kind == "operator":
                around.pop()
        return innermost

    def _find_assertions(self):
        """Spans of text in static_asserts: of them nothing gets into a program."""
        return [(token.start, self.tokens[self.partner[i + 1]].end)
                for i, token in enumerate(self.tokens) if token.text == "static_assert"]

    def spaced(self, i):
        """Whether the token stands between spaces, as binary operators do."""
        token = self.tokens[i]
        return self.text[token.start - 1].isspace() and self.text[token.end].isspace()

    def statements(self):
        """Pairs of token indices (first, last): the simple statements, which end in a semicolon."""
        for i, token in enumerate(self.tokens):
            if token.text != ";" or self.in_body[i] is None or self._inside_parenthesis(i):
                continue
            first = self._statement_start(i)
            if first <= i - 1:
                yield first, i

    def _inside_parenthesis(self, i):
        j = i - 1
        while j > self.in_body[i]:
            if self.tokens[j].text in (")", "}", "]") and self.tokens[j].kind == "operator":
                j = self.partner[j]
            elif self.tokens[j].text == "(":
                return True
            j -= 1
        return False

    def _statement_start(self, i):
        j = i - 1
        while True:
            text = self.tokens[j].text
            if text in (")", "]", "}") and self.tokens[j].kind == "operator":
                opened = self.partner[j]
                if text == "}" and self.in_body[j] == opened:
                    return j + 1  # a block ends before this statement
                head = self.tokens[opened - 1].text
                if text == ")" and head in ("if", "for", "while", "switch"):
                    return j + 1
                j = opened - 1
                continue
            if text in (";", "{", ":") and not self._in_conditional(j):
                return j + 1
            if text == "else":
                return j + 1
            j -= 1

    def _in_conditional(self, i):
        """A colon that belongs to a question mark of the same statement."""
        if self.tokens[i].text != ":":
            return False
        j = i - 1
        while self.tokens[j].text not in (";", "{", "}"):
            if self.tokens[j].text == "?":
                return True
            if self.tokens[j].text == "case":
                return False
            j -= 1
        return False

    def line_of(self, offset):
        """The line at the offset, white space collapsed; and which of its equals it is."""
        lines = self.text.split("\n")
        number = self.text.count("\n", 0, offset)
        line = " ".join(lines[number].split())
        repeat = sum(" ".join(other.split()) == line for other in lines[:number])
        return line, repeat, number + 1
