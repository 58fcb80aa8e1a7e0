"""The storage form of seam sections, decoded by its document (docs/storage-format.md, Seams) alone.

read_stored_seams returns the copies, without restoring the section. It counts the questions that a reader of the section
would ask, because these counts code the table; so all stored words are read.
"""

import array
from collections import defaultdict

from seams_reader import BLOCK, CONTEXTS, LEFT, NEW, Private, Walk
from storage_reader import SCALE, WORD, BitModel, require

MOST_HOMES = 253
SINGLE, UNDECIDED, SEVERAL, DONE, SEAM_END = range(5)
INNER, SEAM, BORDER = range(3)


class Bits:
    """Arithmetic coding of bits."""

    def __init__(self, data):
        self.words, self.at = array.array("I", data), 0
        self.low, self.high, self.number = 0, (1 << 64) - 1, 0
        for _ in range(2):
            self.number = self.number << 32 | self.next()

    def next(self):
        self.at += 1
        return self.words[self.at - 1] if self.at <= len(self.words) else 0

    def take(self, zero):
        middle = self.low + (self.high - self.low) // SCALE * zero
        bit = int(self.number > middle)
        if bit:
            self.low = middle + 1
        else:
            self.high = middle
        while self.low >> 32 == self.high >> 32:
            self.low = (self.low & WORD) << 32
            self.high = (self.high & WORD) << 32 | WORD
            self.number = (self.number & WORD) << 32 | self.next()
        return bit

    def bit(self, model):
        bit = self.take(model.zero)
        model.learn(bit)
        return bit

    def raw(self, count):
        value = 0
        for _ in range(count):
            value = 2 * value + self.take(SCALE // 2)
        return value

    def finish(self):
        require(self.at == len(self.words) + 1 and self.number == (self.low >> 32) + 1 << 32, "words are left, or missing")


class CopyWalk:
    """Sets self.copy: by corner, (vertex, number of the copy)."""

    def __init__(self, bits, slots, vertices):
        self.bits = bits
        self.models = defaultdict(BitModel)
        self.corner_vertex = {3 * t + k: v for t, triangle in enumerate(slots) for k, v in enumerate(triangle)}
        self.corners = [[] for _ in range(vertices)]
        for corner, v in self.corner_vertex.items():
            self.corners[v].append(corner)
        self.status = [UNDECIDED] * vertices
        self.seams = [0] * vertices
        self.copy = {}
        self.stack = []
        for v in range(vertices):
            self.decide(v, "A", v > 0 and self.status[v - 1] != SINGLE)
            if self.status[v] == SEVERAL:
                self.stack.append(v)
            while self.stack:
                u = self.stack.pop()
                if self.status[u] == SEVERAL:
                    self.read_vertex(u)

    def bit(self, *model):
        require(self.bits.at <= len(self.bits.words) + 2, "the words end too early")
        return self.bits.bit(self.models[model])

    def decide(self, v, *model):
        if self.status[v] == UNDECIDED:
            several = len(self.corners[v]) > 1 and self.bit(*model)
            self.status[v] = SEVERAL if several else SINGLE
            if not several:
                self.copy.update((corner, (v, 0)) for corner in self.corners[v])

    def read_vertex(self, v):
        self.v, self.count, self.left = v, 0, len(self.corners[v])
        self.far = []  # by side: the corner at its other end
        for corner in self.corners[v]:
            t, k = divmod(corner, 3)
            self.far += [3 * t + (k + 1) % 3, 3 * t + (k + 2) % 3]
        self.mate = {}
        by_end = defaultdict(list)
        for side, far in enumerate(self.far):
            by_end[self.corner_vertex[far]].append(side)
        for sides in by_end.values():
            for a, b in zip(sides[::2], sides[1::2]):
                self.mate[a], self.mate[b] = b, a
        sides = range(len(self.far))
        ends = [self.end(side) for side in sides]
        for begins, is_seam in (([s for s in sides if ends[s] == SEAM_END], 1), ([s for s in sides if s not in self.mate], 0),
                                (sides[::2], 0)):
            for side in begins:
                for first in (side, self.mate.get(side)) if not self.is_read(side) else ():
                    self.since = 0
                    while first is not None and not self.is_read(first):
                        self.read_corner(first, is_seam)
                        first = self.mate.get(first ^ 1)
        self.status[v] = DONE
        self.visit_neighbors()

    def corner(self, side):
        return self.corners[self.v][side // 2]

    def is_read(self, side):
        return self.corner(side) in self.copy

    def end(self, side):
        status, mate = self.status[self.corner_vertex[self.far[side]]], self.mate.get(side)
        if status == DONE and mate is not None and self.copy[self.far[side]] != self.copy[self.far[mate]]:
            return SEAM_END
        return status

    def read_corner(self, side, is_seam):
        links = []  # end, copy
        for s in (side, side ^ 1):
            if s in self.mate and self.is_read(self.mate[s]):
                links.append((self.end(s), self.copy[self.corner(self.mate[s])][1]))
        links.sort(key=lambda link: link[0])  # stable
        self.left -= 1
        n, copy = min(self.count, 3), None
        asked = list(dict.fromkeys(c for _, c in links))
        if len(links) == 1:
            questions = [("B", links[0][0], n, min(self.since, 3), min(self.left, 3))]
        elif len(asked) == 1:
            questions = [("C", links[0][0], links[1][0], n)]
        elif asked:
            questions = [("D", links[0][0], links[1][0], n), ("E", links[1][0], n)]
        else:
            questions = []
        for model, c in zip(questions, asked):
            if self.bit(*model):
                copy = c
                break
        if copy is None:
            copy = self.other(asked, is_seam)
            self.since = 0
        self.since += 1
        self.copy[self.corner(side)] = (self.v, copy)

    def other(self, asked, is_seam):
        left = [c for c in range(self.count) if c not in asked]
        if not left or self.bit("F", min(len(left), 2), min(self.left, 2), is_seam):
            self.count += 1
            return self.count - 1
        index = self.bits.raw((len(left) - 1).bit_length())
        require(index < len(left), "no such copy")
        return left[index]

    def visit_neighbors(self):
        edges = []
        for side, far in enumerate(self.far):
            mate = self.mate.get(side)
            if mate is None or mate > side:
                differ = mate is not None and self.copy[self.corner(side)] != self.copy[self.corner(mate)]
                w = self.corner_vertex[far]
                edges.append((w, BORDER if mate is None else SEAM if differ else INNER))
                self.seams[w] = min(self.seams[w] + differ, 2)
        for w, kind in edges:
            self.decide(w, "G", kind, self.seams[w])
        for seams in (False, True):
            self.stack += [w for w, kind in edges if (kind == SEAM) == seams and self.status[w] == SEVERAL]


class Homes:
    """The homes of a vertex, and whether it wraps."""

    def __init__(self, v, corners, walk, slots, sides):
        self.slots, self.corners = slots, corners
        copies = {c: walk.copy[c][1] for c in corners}
        on_left = [c for c in corners if sides[c // 3] == LEFT]
        fan = [c for c in self.fan(v + 1, v - 1, 1)[::-1] or self.fan(v - 1, v + 1, 2) if sides[c // 3] == LEFT]
        self.homes = list(dict.fromkeys(copies[c] for c in fan + on_left))[:MOST_HOMES]
        self.homes = self.homes or [copies[c] for c in corners[:1]] or [0]
        if len(self.homes) > 1:
            first, last = ([copies[c] for c in on_left if w in slots[c // 3]][:1] for w in (v - 1, v + 1))
            # They are homes even if there are too many others.
            if last and last != first:
                self.homes = [copy for copy in self.homes if copy != last[0]] + last
            if first:
                self.homes = first + [copy for copy in self.homes if copy != first[0]]
        changed = sum(copies[a] != copies[b] for a, b in zip(fan, fan[1:]))
        self.wraps = len(self.homes) > 1 and changed == len(self.homes) and copies[fan[0]] == copies[fan[-1]]

    def steps(self):
        return len(self.homes) - 1 + self.wraps

    def wrap(self):
        return int(self.wraps)

    def fan(self, a, end, step):
        """The corners from the edge to vertex a to the edge to `end`; a is their next vertex (step 1) or their previous (step 2)."""
        out = []
        while a != end:
            c = next((c for c in self.corners if self.slots[c // 3][(c + step) % 3] == a), None)
            if c is None or c in out:
                break
            out.append(c)
            a = self.slots[c // 3][(c - step) % 3]
        return out


class AnswerWalk(Walk):
    """Asks the questions of a block's reader and answers them from known copies. `answers` collects both."""

    at = end = 0  # like codes of a block that were all read

    def __init__(self, copies, triangles, homes, private):
        """`copies`: by corner of the block. `private`: the numbers of private copies so far; new ones are appended."""
        self.copies, self.homes, self.private, self.answers = copies, homes, private, []
        steps, wraps = ({w: what(homes[w]) for triangle in triangles for w in triangle} for what in (Homes.steps, Homes.wrap))
        super().__init__(self, triangles, steps, wraps, len(private))

    def flag(self, context, answer):
        self.answers.append((context, answer))
        return answer

    def wanted(self, w):
        """The copy of the triangle's corner."""
        i = len(self.states) - 1
        return self.copies[i][self.triangles[i].index(w)]

    def is_wanted(self, w, state):
        if isinstance(state, Private):
            return self.private.get(self.wanted(w)) == state
        return self.homes[w].homes[self.copy(w, state)] == self.wanted(w)[1]

    def changes(self, context, usual, ends):
        out = tuple(not self.is_wanted(w, state) for _, w, state, _, _ in ends)
        if self.flag(context, any(out)):
            self.flag(usual, out == (context != "lone", True))
        return out

    def ask(self, w, questions, current=None):
        own, wanted = self.homes[w].homes, self.wanted(w)
        is_home, left = wanted[1] in own, list(range(len(own)))
        if current is not None and not isinstance(current, Private):
            left.remove(self.copy(w, current))
        for position, context in questions:
            if position is NEW:
                if self.flag(context, not is_home and wanted not in self.private):
                    self.private[wanted] = self.made
                    self.made += 1
                    return Private(self.made - 1)
            elif self.copy(w, position) in left:
                if self.flag(context, self.is_wanted(w, position)):
                    return position
                left.remove(self.copy(w, position))
        if left:
            self.flag("home", is_home)
        return own.index(wanted[1]) if is_home else Private(self.private[wanted])


class SideWalk(Walk):
    """Finds only the sides of a block's triangles."""

    at = end = 0

    def __init__(self, triangles):
        super().__init__(self, triangles, (), (), 0)

    def read_pair(self, i, parent, pair):
        pass

    def read_other(self, i, w, parent):
        pass


def vertex_answers(homes):
    """The questions and answers of the reader of a block of vertices."""
    out, before = [], 0
    for h in homes:
        steps = h.steps()
        out.append((f"v{min(before, 2)}", steps > 0))
        if steps > 0:
            out.append(("more", steps > 1))
        if steps > 1:
            out += [("many", True)] * (steps - 2) + [("many", False)] * (steps < 255) + [("wrap", h.wraps)]
        before = steps
    return out if any(len(h.homes) > 1 for h in homes) else []


def read_table(bits, answers):
    """The table's entries: likely value and class of each context."""
    counts = {context: [0, 0] for context in CONTEXTS}
    for context, answer in answers:
        counts[context][answer] += 1
    models, out = defaultdict(BitModel), []
    for context in CONTEXTS:
        zeros, ones = counts[context]
        total = zeros + ones
        likely = int(ones > zeros) ^ bits.bit(models["usual", total > 0])
        unlikely = counts[context][1 - likely]
        rare = (min(1 + (total // unlikely).bit_length(), 6) if unlikely else 1) if total else 0
        k = 1
        for _ in range(3):
            k = 2 * k + bits.bit(models[rare, k])
        out.append((likely, k - 8))
    return out


def read_stored_seams(data, slots, vertices):
    """The copies of corners, a tuple per slot, and the vertex of each copy, as read_seams returns them."""
    require(len(data) % 4 == 0, "not a whole number of words")
    bits = Bits(data)
    walk = CopyWalk(bits, slots, vertices)
    blocks = [slots[i:i + BLOCK] for i in range(0, len(slots), BLOCK)]
    sides = [side for block in blocks for side in SideWalk(block).sides]
    homes = [Homes(v, walk.corners[v], walk, slots, sides) for v in range(vertices)]
    copies = [[walk.copy[3 * t + k] for k in range(len(triangle))] for t, triangle in enumerate(slots)]
    answers, private = [], {}
    several = [len({walk.copy[c] for c in corners}) > 1 for corners in walk.corners]
    for i in range(0, vertices, BLOCK):
        answers += vertex_answers(homes[i:i + BLOCK])
    for i, block in enumerate(blocks):
        reader = AnswerWalk(copies[BLOCK * i:BLOCK * (i + 1)], block, homes, private)
        if any(several[v] for triangle in block for v in triangle):
            answers += reader.answers
    read_table(bits, answers)
    bits.finish()
    names = [(v, copy) for v in range(vertices) for copy in homes[v].homes] + list(private)
    number = {copy: i for i, copy in enumerate(names)}
    return [tuple(number[copy] for copy in of) for of in copies], [v for v, _ in names]
