"""Cards of a deck: a keyword line with its data lines."""

from dataclasses import dataclass, field


@dataclass
class Card:
    """One keyword line with its data lines."""

    keyword: str
    """In capitals, without blanks: `CONTACTPAIR`."""
    head: str
    """Text of the keyword line."""
    rows: list[list[str]] = field(default_factory=list)
    """Fields of the data lines; free text, under HEADING and STEP, is one field a line."""

    @property
    def parameters(self) -> dict[str, str]:
        """Parameters of the keyword line; their names are in capitals without blanks."""
        pairs = (part.partition("=") for part in fields(self.head)[1:])
        return {fold(name): value.strip() for name, _, value in pairs if name.strip()}

    def text(self) -> str:
        """The card as text of a deck."""
        return "\n".join([self.head, *(", ".join(row) for row in self.rows)]) + "\n"


def fields(line: str) -> list[str]:
    """Fields of a line; commas separate them, except commas between quotation marks."""
    if '"' not in line:
        return [part.strip() for part in line.split(",")]
    parts = [""]
    quoted = False
    for character in line:
        quoted ^= character == '"'
        if character == "," and not quoted:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]


def fold(text: str) -> str:
    """The form in which words are compared: capitals without blanks."""
    return "".join(text.split()).upper()
