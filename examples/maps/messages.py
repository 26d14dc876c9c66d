"""Writes the two messages of signboard.tex: 192 × 24 lamps, 255 where one blinks."""
from PIL import Image

LETTERS = {
    "A": "01110 10001 10001 11111 10001 10001 10001",
    "E": "11111 10000 10000 11110 10000 10000 11111",
    "G": "01110 10001 10000 10111 10001 10001 01110",
    "H": "10001 10001 10001 11111 10001 10001 10001",
    "N": "10001 11001 10101 10101 10011 10001 10001",
    "P": "11110 10001 10001 11110 10000 10000 10000",
    "R": "11110 10001 10001 11110 10100 10010 10001",
    "S": "01111 10000 10000 01110 00001 00001 11110",
    "T": "11111 00100 00100 00100 00100 00100 00100",
    "U": "10001 10001 10001 10001 10001 10001 01110",
    "X": "10001 10001 01010 00100 01010 10001 10001",
    " ": "00000 00000 00000 00000 00000 00000 00000",
}


def board(text, path):
    picture = Image.new("L", (192, 24))
    for place, letter in enumerate(text):
        for row, dots in enumerate(LETTERS[letter].split()):
            for column, dot in enumerate(dots):
                if dot == "1":
                    x, y = place * 12 + column * 2 + 1, row * 2 + 5
                    picture.paste(255, (x, y, x + 2, y + 2))
    picture.save(path, optimize=True)


board("TEXGRAPH TEXTURE", "message.png")
board("PATTERNS AT REST", "before.png")
