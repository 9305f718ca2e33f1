"""The instruments of this folder see what they are for."""

from __future__ import annotations

from urllib.error import HTTPError
from urllib.request import urlopen

import pyogrio
import pytest


def test_a_file_that_is_opened_is_seen(canary):
    canary.watch()
    assert not canary.was_opened
    canary.csv.read_text()
    assert canary.was_opened
    assert not canary.was_opened
    pyogrio.list_layers(canary.csv)
    assert canary.was_opened


def test_a_request_is_seen(listener):
    with pytest.raises(HTTPError):
        urlopen(listener.url + "/here")
    assert listener.requests == ["GET /here"]
