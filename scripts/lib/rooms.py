"""The rooms of the house, as CMakeLists.txt names them."""
import re

from script import ROOT

HELPER = re.compile(r"_test\.cpp$|test_\w+\.h$")  # tests of core and what only they include
ROOM = re.compile(r"^\s*cscd_room\((.*?)\)", re.M | re.S)


def read_rooms(cmake_lists):
    """Room name to what it uses and what its tests use beside that, bottom-up."""
    rooms = {}
    for call in ROOM.findall(cmake_lists.read_text()):
        room, *words = call.split()
        lists, keyword = {"USES": [], "TEST_USES": []}, None
        for word in words:
            if re.fullmatch(r"[A-Z_]+", word):
                keyword = word
            else:
                lists.setdefault(keyword, []).append(word)
        rooms[room] = (lists["USES"], lists["TEST_USES"])
    return rooms


def test_programs(rooms, of="core/|library$|scenes/queries$"):
    """The test programs of those rooms, by default of core and of the library, that have tests."""
    return [room.replace("/", "_") + "_test" for room in rooms if re.match(of, room) and list((ROOT / room).glob("*_test.cpp"))]


def closure(rooms, start):
    """The rooms of `start` and all that they use."""
    seen, todo = set(), list(start)
    while todo:
        room = todo.pop()
        if room not in seen:
            seen.add(room)
            todo += rooms.get(room, ([], []))[0]
    return seen


def above(rooms, room):
    """Rooms that use a room, or whose tests do, bottom-up."""
    return [name for name, (uses, test_uses) in rooms.items() if name != room and room in closure(rooms, uses + test_uses)]
