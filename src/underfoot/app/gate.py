"""Who may talk to the server: one person with the address, from a page of this server.

The address carries a random token once; it becomes a cookie. Every request is checked for the
cookie, for a host that is no name of another site (DNS rebinding) and, where the browser says it,
for its own origin. Bodies are bounded before they are read. Pages may load nothing from elsewhere.
"""

from __future__ import annotations

import hashlib
import hmac
import ipaddress
from collections.abc import Awaitable, Callable, MutableMapping
from html import escape
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode, urlsplit

from underfoot.core.remark import Message

Scope = MutableMapping[str, Any]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
UPLOADS = "/api/files/"
"""Path under which large bodies are taken."""
MOST_BYTES = 1_000_000
"""Of a body anywhere else."""
POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' "
    "'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
)
"""What a page may load: nothing from another machine. The framework compiles its templates."""


class Gate:
    """An ASGI application in front of ``app`` that lets only its own pages through.

    Parameters:
        token: Secret of the address.
        port: Port that the server listens on.
        name: Name of this machine that the server alone goes by (``own_name``).
        most_bytes: Largest upload.
    """

    def __init__(self, app: Any, token: str, port: int, most_bytes: int, name: str = "") -> None:
        self.app = app
        self._token = token
        self._port = port
        self._names = ("localhost", name)
        self._most = most_bytes
        self._cookie = f"underfoot-{port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request, or refuse it in words."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        headers = {k.decode("latin-1"): v.decode("latin-1") for k, v in scope["headers"]}
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        if not self._own_host(headers):
            await _refuse(scope, send, 403, "This address is not one of this server.")
        elif self._has_token(dict(query).get("token", "")) and scope["type"] == "http":
            rest = urlencode([pair for pair in query if pair[0] != "token"])
            # quoted: no backslash or letter of another alphabet leads to another server
            place = quote(scope["path"].lstrip("/\\")) + (f"?{rest}" if rest else "")
            cookie = f"{self._cookie}={self._token}; HttpOnly; SameSite=Strict; Path=/"
            further = [("location", f"/{place}"), ("set-cookie", cookie)]
            await _refuse(scope, send, 303, "", further)
        elif not self._has_token(self._token_of(headers)):
            message = (
                "Open the address that the terminal shows where the app was started: it ends with "
                "a key that is yours alone."
            )
            await _refuse(scope, send, 403, message)
        elif (excess := self._excess(scope, headers)) is not None:
            await _refuse(scope, send, *excess)
        else:
            await self.app(scope, receive, _with_policy(send))

    def _own_host(self, headers: dict[str, str]) -> bool:
        """Return whether host and origin are this server, by a number, as localhost or its name.

        A page of another site reaches this server only by a name that it controls.
        """
        host = headers.get("host", "")
        name, port = _host_and_port(host)
        try:
            ipaddress.ip_address(name)
        except ValueError:
            if not name or name not in self._names:
                return False
        origin = headers.get("origin")
        return port == self._port and origin in (None, f"http://{host}")

    def _token_of(self, headers: dict[str, str]) -> str:
        try:
            morsel = SimpleCookie(headers.get("cookie", "")).get(self._cookie)
        except CookieError:
            return ""
        return "" if morsel is None else morsel.value

    def _has_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self._token.encode())

    def _excess(self, scope: Scope, headers: dict[str, str]) -> tuple[int, str] | None:
        if scope["type"] != "http" or scope["method"] in ("GET", "HEAD"):
            return None
        length = headers.get("content-length", "")
        if not length.isdigit():
            return 411, "The request does not say how long it is."
        most = self._most if scope["path"].startswith(UPLOADS) else MOST_BYTES
        if int(length) > most:
            return 413, too_large(int(length), most)
        return None


def own_name(token: str) -> str:
    """Return a name of this machine that nobody can guess and the token can't be told from.

    Browsers take every name below localhost for this machine, and send the cookie of a host to all
    of its ports: under a name of its own no other program here is sent it.
    """
    return f"underfoot-{hashlib.sha256(token.encode()).hexdigest()[:16]}.localhost"


def too_large(size: int, most: int) -> Message:
    """Return what is said to a file that is too large."""
    return Message(
        "The file has {size:.0f} MB. Allowed: at most {most:.0f} MB. Export the sole alone, "
        "without the upper and the last, or with a coarser mesh (0.1 mm is fine enough).",
        size=size / 1e6,
        most=most / 1e6,
    )


def _host_and_port(host: str) -> tuple[str, int | None]:
    try:
        parts = urlsplit(f"//{host}")
        return parts.hostname or "", parts.port or 80
    except ValueError:
        return "", None


def _with_policy(send: Send) -> Send:
    async def further(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            message["headers"] = [
                *message.get("headers", []),
                (b"content-security-policy", POLICY.encode()),
                (b"x-content-type-options", b"nosniff"),
                (b"referrer-policy", b"no-referrer"),
            ]
        await send(message)

    return further


async def _refuse(
    scope: Scope,
    send: Send,
    status: int,
    message: str,
    further: list[tuple[str, str]] | None = None,
) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008, "reason": message[:120]})
        return
    page = f"<!doctype html><title>Underfoot</title><p>{escape(message)}</p>" if message else ""
    headers = [("content-type", "text/html; charset=utf-8"), *(further or [])]
    coded = [(key.encode(), value.encode("latin-1")) for key, value in headers]
    await send({"type": "http.response.start", "status": status, "headers": coded})
    await send({"type": "http.response.body", "body": page.encode()})
