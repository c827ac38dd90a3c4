"""Section of a case for the plan form and the profile of a heel or a whole sole."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from .quantity import default
from .sections_base import Angle, LargeRadius, Length, Rounding, Section

_HEEL = "assumption"
_mm = 1e-3


class HeelShape(Section):
    """Heel or whole sole in its own frame: x from the rear end towards the toe."""

    plan: Literal["heel", "sole"] = default("heel", "heel", "the heel carries the slip tester")
    length: Length = default(60 * _mm, "60 mm", _HEEL, assumed=True)
    width: Length = default(60 * _mm, "60 mm", _HEEL, assumed=True)
    rear_radius: Rounding = default(28 * _mm, "28 mm", _HEEL, assumed=True)
    front_radius: Rounding = default(0.0, "0 mm", "the heel goes on into the shoe")
    side: Literal["left", "right"] = default("right", "right", "sole: which foot, seen from above")
    waist_width: Length | None = Field(default=None, description="sole: at its narrowest")
    ball_width: Length | None = Field(default=None, description="sole: across the ball")
    toe_spring: Rounding | None = Field(default=None, description="sole: how far the tip is up")
    toe_start: Length | None = Field(
        default=None, description="sole: where the toe begins to rise, from the rear end"
    )
    profile: Literal["flat", "facet", "rocker"] = default("facet", "facet", _HEEL, assumed=True)
    facet_angle: Angle | None = Field(default=None, description="facet: between facet and sole")
    facet_length: Length | None = Field(
        default=None, description="facet: along the sole, from the rear"
    )
    rocker_radius: LargeRadius | None = Field(default=None, description="rocker: radius along x")
    rocker_start: Length | None = Field(default=None, description="rocker: from the rear end")
    edge_radius: Rounding = default(2 * _mm, "2 mm", _HEEL, assumed=True)
    crown_radius: LargeRadius | None = Field(
        default=None, description="radius of a sole bulged across"
    )
