"""Lips in frameworks for voice agents: :mod:`labial.integrations.pipecat` and :mod:`labial.integrations.livekit`.

Each needs its framework, which the extras `pipecat` and `livekit` install; :mod:`labial.integrations.lips` is what they
share.
"""
