"""Who is let in: token, cookie, host, origin, sizes; and files that arrive."""

import asyncio

import pytest

pytest.importorskip("nicegui")

from underfoot.app.gate import Gate, own_name
from underfoot.app.project import Project
from underfoot.app.uploads import receive_file, revisions, upload_path
from underfoot.core import InputError

TOKEN, PORT = "t" * 40, 8642
COOKIE = f"underfoot-{PORT}={TOKEN}"


def asked(path="/", query="", method="GET", kind="http", **headers):
    """Return (status, headers, body) of one request; the application answers 200."""
    sent = []

    async def app(scope, receive, send):
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b"in"})

    async def send(message):
        sent.append(message)

    headers = {"host": f"127.0.0.1:{PORT}", **headers}
    scope = {
        "type": kind, "path": path, "method": method, "query_string": query.encode(),
        "headers": [(k.replace("_", "-").encode(), v.encode()) for k, v in headers.items()],
    }  # fmt: skip
    asyncio.run(Gate(app, TOKEN, PORT, 300_000_000, own_name(TOKEN))(scope, None, send))
    if kind == "websocket" and sent[0]["type"] == "websocket.close":
        return 403, {}, b""
    found = {k.decode(): v.decode() for k, v in sent[0]["headers"]}
    return sent[0]["status"], found, sent[1]["body"]


def test_the_token_becomes_a_cookie_and_leaves_the_address():
    status, headers, _ = asked("/design", f"variant=a&token={TOKEN}")
    assert status == 303
    assert headers["location"] == "/design?variant=a"
    for path, place in (
        ("/\\evil.example", "/evil.example"),
        ("//evil.example", "/evil.example"),
        ("/€\n", "/%E2%82%AC%0A"),
    ):
        assert asked(path, f"token={TOKEN}")[1]["location"] == place
    assert "HttpOnly" in headers["set-cookie"]
    assert "SameSite=Strict" in headers["set-cookie"]


@pytest.mark.parametrize("cookie", ["", "underfoot-8642=wrong", "underfoot-1=" + TOKEN, ";;="])
def test_without_the_cookie_nothing_is_told(cookie):
    status, _, body = asked(cookie=cookie)
    assert status == 403
    assert b"terminal" in body
    assert asked(kind="websocket", cookie=cookie)[0] == 403


def test_a_wrong_token_is_refused():
    assert asked(query="token=" + "u" * 40)[0] == 403


@pytest.mark.parametrize(
    "host", ["evil.example:8642", "127.0.0.1:80", "127.0.0.1", "", "[::1", "localhost.evil:8642"]
)
def test_names_of_other_sites_are_refused_even_with_the_cookie(host):
    assert asked(cookie=COOKIE, host=host)[0] == 403


def test_the_name_of_its_own_is_let_in_and_tells_nothing_of_the_token():
    name = own_name(TOKEN)
    assert name.endswith(".localhost")
    assert TOKEN[:6] not in name
    assert own_name("u" * 40) != name
    assert asked(cookie=COOKIE, host=f"{name}:{PORT}", origin=f"http://{name}:{PORT}")[0] == 200
    assert asked(cookie=COOKIE, host=f"{name}:{PORT}", origin=f"http://{name}:1")[0] == 403
    assert asked(cookie=COOKIE, host=f"underfoot-0.localhost:{PORT}")[0] == 403


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8642", "localhost:8642", "[::1]:8642", "10.0.0.7:8642"]
)
def test_this_machine_is_let_in(host):
    assert asked(cookie=COOKIE, host=host)[0] == 200


def test_pages_of_other_sites_can_not_ask():
    own = f"http://127.0.0.1:{PORT}"
    assert asked(cookie=COOKIE, origin=own)[0] == 200
    for origin in ("http://evil.example", "null", f"https://127.0.0.1:{PORT}"):
        assert asked(cookie=COOKIE, origin=origin)[0] == 403
        assert asked(kind="websocket", cookie=COOKIE, origin=origin)[0] == 403


def test_pages_may_load_nothing_from_elsewhere():
    policy = asked(cookie=COOKIE)[1]["content-security-policy"]
    assert "default-src 'self'" in policy
    assert "http" not in policy


def test_two_gigabytes_are_refused_in_words_before_they_are_read():
    size = {"content_length": "2000000000"}
    status, _, body = asked("/api/files/soles/a.stl", method="POST", cookie=COOKIE, **size)
    assert status == 413
    assert b"2000 MB. Allowed: at most 300 MB" in body
    assert asked("/api/ask/x", method="POST", cookie=COOKIE, content_length="2000000")[0] == 413
    assert asked("/api/ask/x", method="POST", cookie=COOKIE)[0] == 411


async def stream(*chunks):
    for chunk in chunks:
        yield chunk


def test_files_arrive_whole_or_not_at_all(tmp_path, monkeypatch):
    project = Project(tmp_path)
    path = asyncio.run(receive_file(project, "soles/heel.stl", stream(b"ab", b"c")))
    assert path == tmp_path / "soles" / "heel.stl"
    assert path.read_bytes() == b"abc"
    monkeypatch.setattr("underfoot.app.uploads.MOST_BYTES", 4)
    with pytest.raises(InputError, match="Allowed: at most"):
        asyncio.run(receive_file(project, "soles/heel.stl", stream(b"abc", b"def")))
    with pytest.raises(InputError, match="empty"):
        asyncio.run(receive_file(project, "soles/heel.stl", stream()))
    assert [p.name for p in (tmp_path / "soles").iterdir()] == ["heel.stl"]
    assert path.read_bytes() == b"abc"


def test_a_file_of_a_taken_name_is_its_next_revision(tmp_path):
    project = Project(tmp_path)

    def dropped(*chunks):
        return asyncio.run(receive_file(project, "soles/heel.stl", stream(*chunks)))

    paths = [dropped(b"%d" % number) for number in range(20)]
    assert dropped(b"3") == paths[3]  # of the same content there is one file
    assert [path.read_bytes() for path in paths] == [b"%d" % number for number in range(20)]
    assert paths[:2] == [tmp_path / "soles" / "heel.stl", tmp_path / "soles/heel, revision 2.stl"]
    assert revisions(paths[7]) == paths
    assert len(list((tmp_path / "soles").iterdir())) == 20
    other = asyncio.run(receive_file(project, "soles/heel, revision 4.stl", stream(b"new")))
    assert other.name == "heel, revision 21.stl"


@pytest.mark.parametrize("name", ["(1) Heel v2.stl", "Sohle für Öl.STEP", "a" * 110 + ".stl"])
def test_names_as_people_and_browsers_write_them(tmp_path, name):
    assert upload_path(Project(tmp_path), f"soles/{name}").name == name


@pytest.mark.parametrize(
    "place",
    [
        *("variants/a.toml", "soles", "soles/", "soles/../a", "soles/.x", "soles/a:b", "/etc/x"),
        *("soles/con.stl", "soles/a.", "soles/ a.stl", f"soles/{'a' * 130}.stl"),
    ],
)
def test_files_go_nowhere_else(tmp_path, place):
    with pytest.raises(InputError):
        upload_path(Project(tmp_path), place)
