"""The page served to browsers on this machine alone, and the stream of events that moves it."""

from __future__ import annotations

import sys
import time
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, cast

from synth.errors import SynthError

if TYPE_CHECKING:
    from synth.live.feed import Feed

ADDRESS = "127.0.0.1"
_LEAST_APART = 1.0 / 60.0  # s, between two tellings: no screen shows more
_HEARTBEAT = 1.0  # s, after which a browser that has gone is noticed
_RETRY = 500  # ms, after which a browser comes again when the stream was dropped


class PageServer(ThreadingHTTPServer):
    """Serves one page and its events, on the loopback address and nowhere else.

    Args:
        page: The page.
        feed: What is told.
        port: The port; 0 for any that is free.
    """

    daemon_threads = True

    def __init__(self, page: bytes, feed: Feed, port: int) -> None:
        self.page, self.feed = page, feed
        super().__init__((ADDRESS, port), _Handler)

    def handle_error(self, request: object, client_address: object) -> None:
        """Say nothing of a browser that has gone; of anything else what the library says."""
        if not isinstance(sys.exception(), OSError):
            super().handle_error(request, client_address)  # type: ignore[arg-type]


class _Handler(BaseHTTPRequestHandler):
    """Answers a browser: the page, or events until it goes."""

    server_version = "synth"

    def do_GET(self) -> None:
        """Answer a request."""
        if self.headers.get("Host", "").rpartition(":")[0] not in {ADDRESS, "localhost"}:
            self.send_error(HTTPStatus.FORBIDDEN)  # a name from elsewhere that was made to lead here
        elif self.path == "/":
            self._send_head("text/html; charset=utf-8")
            self.wfile.write(self._served.page)
        elif self.path == "/events":
            self._send_head("text/event-stream")
            self._send_events(self._served.feed)
        else:
            self.send_error(HTTPStatus.NOT_FOUND)

    @property
    def _served(self) -> PageServer:
        return cast("PageServer", self.server)

    def _send_events(self, feed: Feed) -> None:
        """Send what is new, the newest of each kind, until the browser has gone or nothing more is told."""
        number, due = 0, time.monotonic()
        try:
            self.wfile.write(f"retry: {_RETRY}\n\n".encode())
            while not feed.closed:
                number, events = feed.after(number, _HEARTBEAT)
                text = "".join(f"event: {kind}\ndata: {data}\n\n" for kind, data in events)
                self.wfile.write((text or ": still here\n\n").encode())
                self.wfile.flush()
                now = time.monotonic()
                due = max(due + _LEAST_APART, now)
                time.sleep(due - now)
        except OSError:
            self.close_connection = True

    def _send_head(self, content: str) -> None:
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", content)
        self.send_header("Cache-Control", "no-store")
        self.end_headers()

    def log_message(self, *_told: object) -> None:
        """Say nothing of each request."""


def page_server(page: bytes, feed: Feed, port: int) -> PageServer:
    """Return a server of a page and its events; see `PageServer`.

    Raises:
        SynthError: The port is taken.
    """
    try:
        return PageServer(page, feed, port)
    except OSError as error:
        raise SynthError(f"cannot serve on port {port}: {error.strerror or error}") from error
