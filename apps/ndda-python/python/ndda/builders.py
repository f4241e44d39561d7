"""Scenes as objects, with completion; what is left out has the scene's default.

Written by `write_builders.py` from the schema of scenes, and not by hand.

>>> rock = Material(name="rock", density_kg_m3=2600.0, young_pa=1e9, poisson=0.25)
>>> block = Block(name="block", material="rock", shape=Shape.Box(size_m=(1, 1, 1), cells=(1, 1, 1)), body=Body.Rigid)
>>> scene = Scene(title="A block", time=Time(step_s=0.01, end_s=1.0), materials=[rock], blocks=[block])
>>> import ndda
>>> ndda.parse(scene).steps
100
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, TypeAlias

from ndda._builder import Builder


class AccelerationUnit:
    """Unit of a record.

    Examples
    --------
    >>> AccelerationUnit.G
    'G'
    """

    # Standard gravity, 9.80665 m/s².
    G: ClassVar[Literal["G"]] = "G"
    # m/s².
    MetrePerSecondSquared: ClassVar[Literal["MetrePerSecondSquared"]] = "MetrePerSecondSquared"
    # cm/s², gal.
    CentimetrePerSecondSquared: ClassVar[Literal["CentimetrePerSecondSquared"]] = "CentimetrePerSecondSquared"


class At:
    """A place on a block.

    Examples
    --------
    >>> At.Centre
    'Centre'
    """

    # The mass centre.
    Centre: ClassVar[Literal["Centre"]] = "Centre"

    @dataclass
    class Point(Builder):
        """The material point that is here at the start [m].

        Parameters
        ----------
        value : Sequence[float]
            The material point that is here at the start [m].

        Examples
        --------
        >>> At.Point((1.0, 1.0, 1.0)).to_ron()
        'Point((1.0, 1.0, 1.0))'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "(num)"}
        _variant: ClassVar[str] = "Point"

    @dataclass
    class Largest(Builder):
        """Whichever node has moved farthest in a direction: another one at any time.

        Parameters
        ----------
        value : Sequence[float]
            Whichever node has moved farthest in a direction: another one at any time.

        Examples
        --------
        >>> At.Largest((1.0, 1.0, 1.0)).to_ron()
        'Largest((1.0, 1.0, 1.0))'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "(num)"}
        _variant: ClassVar[str] = "Largest"


class Axis:
    """A coordinate axis.

    Examples
    --------
    >>> Axis.X
    'X'
    """

    # East.
    X: ClassVar[Literal["X"]] = "X"
    # North.
    Y: ClassVar[Literal["Y"]] = "Y"
    # Up.
    Z: ClassVar[Literal["Z"]] = "Z"


class Baseline:
    """The baseline of a record's velocity: the polynomial through zero at the first row that fits the
    velocity best, by least squares over time.

    Examples
    --------
    >>> Baseline.None_
    'None'
    """

    # Nothing is taken out.
    None_: ClassVar[Literal["None"]] = "None"
    # c₁ t: a constant acceleration.
    Linear: ClassVar[Literal["Linear"]] = "Linear"
    # c₁ t + c₂ t²: an acceleration that grows linearly.
    Quadratic: ClassVar[Literal["Quadratic"]] = "Quadratic"


@dataclass(kw_only=True)
class Bedding(Builder):
    """Moduli of a bedded rock across its beds (transverse isotropy).

    Parameters
    ----------
    normal : Sequence[float]
        Normal of the beds in the scene's axes, whatever turns a block has; its length does not matter.
    young_across_pa : float
        Young's modulus E′ across the beds [Pa].
    poisson_across : float
        Poisson's ratio ν′ [-]: strain along the beds over that across, under a stress across.
    shear_across_pa : float
        Shear modulus G′ across the beds [Pa].

    Examples
    --------
    >>> Bedding(normal=(1.0, 1.0, 1.0), young_across_pa=1.0, poisson_across=1.0, shear_across_pa=1.0).to_ron()
    '(normal: (1.0, 1.0, 1.0), young_across_pa: 1.0, poisson_across: 1.0, shear_across_pa: 1.0)'
    """

    normal: Sequence[float]
    young_across_pa: float
    poisson_across: float
    shear_across_pa: float
    _kinds: ClassVar[Mapping[str, str]] = {"normal": "(num)", "young_across_pa": "num", "poisson_across": "num", "shear_across_pa": "num"}


@dataclass(kw_only=True)
class Blast(Builder):
    """Pressure of an explosion on faces, along their inward normals as they are at any time.

    ```text blasts: [ (block: "bench_*", on: Hole(from_m: (0, 3, 0), to_m: (0, 3, 8), within_m: 0.2),
    pressure: Duvall(peak_pa: Megapascal(200), alpha_per_s: 1200, beta_per_s: 12000), start_s: 0.025), ], ```

    Parameters
    ----------
    block : str
        Name of the block; in `bench_*` the star stands for anything, and all such blocks with faces there
        count.
    on : BlastWallChoice
        Which faces.
    pressure : BlastPressureChoice
        Pressure over the time since the detonation.
    start_s : float, optional
        When it detonates [s]. Default: 0.

    Examples
    --------
    >>> Blast(block="name", on=BlastWall.Part(Region.All), pressure=BlastPressure.Rows([(1.0, 1.0, 1.0)])).to_ron()
    '(block: "name", on: Part(All), pressure: Rows([(1.0, 1.0, 1.0)]))'
    """

    block: str
    on: BlastWallChoice
    pressure: BlastPressureChoice
    start_s: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "on": "BlastWall", "pressure": "BlastPressure", "start_s": "num"}


class BlastPressure:
    """A pressure over time.

    Examples
    --------
    >>> BlastPressure.Rows([(1.0, 1.0, 1.0)]).to_ron()
    'Rows([(1.0, 1.0, 1.0)])'
    """

    @dataclass
    class Rows(Builder):
        """(time [s], pressure [Pa]), linear between rows, and nothing before the first and after the last.

        Parameters
        ----------
        value : Sequence[Sequence[float]]
            (time [s], pressure [Pa]), linear between rows, and nothing before the first and after the last.

        Examples
        --------
        >>> BlastPressure.Rows([(1.0, 1.0, 1.0)]).to_ron()
        'Rows([(1.0, 1.0, 1.0)])'
        """

        value: Sequence[Sequence[float]]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "[(num)]"}
        _variant: ClassVar[str] = "Rows"

    @dataclass(kw_only=True)
    class Duvall(Builder):
        """p₀ ξ (exp(−α t) − exp(−β t)) with ξ such that p₀ is the peak (Duvall 1953), which comes after
        ln(β/α)/(β − α).

        Parameters
        ----------
        peak_pa : float
            p₀ [Pa].
        alpha_per_s : float
            α, which says how fast it falls [1/s].
        beta_per_s : float
            β, which says how fast it rises, above α [1/s].

        Examples
        --------
        >>> BlastPressure.Duvall(peak_pa=1.0, alpha_per_s=1.0, beta_per_s=1.0).to_ron()
        'Duvall(peak_pa: 1.0, alpha_per_s: 1.0, beta_per_s: 1.0)'
        """

        peak_pa: float
        alpha_per_s: float
        beta_per_s: float
        _kinds: ClassVar[Mapping[str, str]] = {"peak_pa": "num", "alpha_per_s": "num", "beta_per_s": "num"}
        _variant: ClassVar[str] = "Duvall"


class BlastWall:
    """Faces that an explosion presses on.

    Examples
    --------
    >>> BlastWall.Part(Region.All).to_ron()
    'Part(All)'
    """

    @dataclass
    class Part(Builder):
        """Boundary triangles of which all corners are in a region.

        Parameters
        ----------
        value : RegionChoice
            Boundary triangles of which all corners are in a region.

        Examples
        --------
        >>> BlastWall.Part(Region.All).to_ron()
        'Part(All)'
        """

        value: RegionChoice
        _kinds: ClassVar[Mapping[str, str]] = {"value": "Region"}
        _variant: ClassVar[str] = "Part"

    @dataclass(kw_only=True)
    class Hole(Builder):
        """The charged part of a hole: boundary triangles of which all corners are near its axis, and not
        beyond its ends by more than 1 % of that distance.

        Parameters
        ----------
        from_m : Sequence[float]
            One end of the charge [m].
        to_m : Sequence[float]
            Its other end [m].
        within_m : float
            Largest distance of a corner from the axis [m]: a little more than the radius of the meshed hole.

        Examples
        --------
        >>> BlastWall.Hole(from_m=(1.0, 1.0, 1.0), to_m=(1.0, 1.0, 1.0), within_m=1.0).to_ron()
        'Hole(from_m: (1.0, 1.0, 1.0), to_m: (1.0, 1.0, 1.0), within_m: 1.0)'
        """

        from_m: Sequence[float]
        to_m: Sequence[float]
        within_m: float
        _kinds: ClassVar[Mapping[str, str]] = {"from_m": "(num)", "to_m": "(num)", "within_m": "num"}
        _variant: ClassVar[str] = "Hole"


@dataclass(kw_only=True)
class Block(Builder):
    """One block of rock.

    Parameters
    ----------
    name : str
        Name, unique in the scene.
    material : str
        Name of its material.
    shape : ShapeChoice
        Its shape and mesh.
    body : BodyChoice, optional
        How it may move. Default: `Elastic`.
    turns : list[Turn], optional
        Turns applied one after the other about the shape's own origin, before `at_m`. Default: none.
    at_m : Sequence[float], optional
        Position of the shape's origin [m]. Default: (0, 0, 0).
    velocity_m_s : Sequence[float], optional
        Initial velocity of the mass centre [m/s]. Default: at rest.
    spin_rad_s : Sequence[float], optional
        Initial rate of rotation about the mass centre [rad/s]. Default: none.
    initial_stress_pa : Stress, optional
        Uniform initial stress σ₀ [Pa], tension positive. Default: none.

    Examples
    --------
    >>> Block(name="name", material="name", shape=Shape.Box(size_m=(1.0, 1.0, 1.0), cells=(1, 1, 1))).to_ron()
    '(name: "name", material: "name", shape: Box(size_m: (1.0, 1.0, 1.0), cells: (1, 1, 1)))'
    """

    name: str
    material: str
    shape: ShapeChoice
    body: BodyChoice | None = None
    turns: list[Turn] | None = None
    at_m: Sequence[float] | None = None
    velocity_m_s: Sequence[float] | None = None
    spin_rad_s: Sequence[float] | None = None
    initial_stress_pa: Stress | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "material": "str", "shape": "Shape", "body": "Body", "turns": "[Turn]", "at_m": "(num)", "velocity_m_s": "(num)", "spin_rad_s": "(num)", "initial_stress_pa": "Stress"}


class Body:
    """How a block may move.

    Examples
    --------
    >>> Body.Elastic
    'Elastic'
    """

    # Deforms as its mesh lets it.
    Elastic: ClassVar[Literal["Elastic"]] = "Elastic"
    # Deforms uniformly, 12 unknowns: the first-order block of classic DDA.
    Affine: ClassVar[Literal["Affine"]] = "Affine"
    # Does not deform, 6 unknowns; cannot be held in parts.
    Rigid: ClassVar[Literal["Rigid"]] = "Rigid"
    # Stays where it is, or goes where one support with a `Motion`, an `Acceleration` or a `Shaking` takes it
    # as a whole; no unknowns.
    Fixed: ClassVar[Literal["Fixed"]] = "Fixed"


@dataclass(kw_only=True)
class Bolt(Builder):
    """A rock bolt, or rows of equal ones: a bar in a borehole, held by grout over all of its length or a part
    of it.

    A bolt has no mass; in each step its forces are in balance. Tension acts along it and turns with the
    blocks. Where it crosses from one block to the next, a dowel resists shear. ```text bolts: [ // A fully
    grouted bolt of 3 m with a plate. (name: "one", at: Line(from_m: (0, 0, 0), to_m: (0, 0, 3)), steel:
    (young_pa: 200e9, area_m2: 491e-6, yield_n: 245e3, break_strain: 0.05), grout: (stiffness_n_m2: 2e9,
    strength_n_m: 400e3), plate: (strength_n: 150e3)), // Rows of anchors with a free length of 9 m, tensioned
    to 600 kN. (name: "anchor", at: Rows(corner_m: (0, 0, 2), along_m: (0, 20, 0), up_m: (0, 0, 6), spacing_m:
    (4, 3), direction: (1, 0, -0.26), length_m: 15), steel: (young_pa: 195e9, area_m2: 840e-6, yield_n:
    1300e3), grout: (stiffness_n_m2: 2e9, strength_n_m: 400e3, from_m: 9), pretension_n: 600e3, plate: ()), ],
    ```

    Parameters
    ----------
    name : str
        Name; those of rows get the numbers of row and column, as in `anchor_1_3`.
    at : BoltPlaceChoice
        Where it is.
    steel : BoltSteel
        Its bar.
    grout : BoltGrout
        Its bond to the rock.
    dowel : BoltDowel, optional
        Resistance to shear at joints. Default: none.
    pretension_n : float, optional
        Tension with which the bolt is locked, jacked against the plate [N]. What blocks and contact give way
        under it from then on takes part of it: in a cube of 2 m under 500 kN 0.2 % with E = 10 GPa, 1.4 %
        with 1 GPa. Default: none.
    plate : BoltPlate, optional
        Plate that ties the head to the face. Default: none.
    segment_m : float, optional
        Longest segment of the bonded length [m]; at most 1/(4λ), λ = √(k_b/EA). Default: 1/(8λ).

    Examples
    --------
    >>> Bolt(name="name", at=BoltPlace.Line(from_m=(1.0, 1.0, 1.0), to_m=(1.0, 1.0, 1.0)), steel=BoltSteel(young_pa=1.0, area_m2=1.0), grout=BoltGrout(stiffness_n_m2=1.0, strength_n_m=1.0)).to_ron()
    '(name: "name", at: Line(from_m: (1.0, 1.0, 1.0), to_m: (1.0, 1.0, 1.0)), steel: (young_pa: 1.0, area_m2: 1.0), grout: (stiffness_n_m2: 1.0, strength_n_m: 1.0))'
    """

    name: str
    at: BoltPlaceChoice
    steel: BoltSteel
    grout: BoltGrout
    dowel: BoltDowel | None = None
    pretension_n: float | None = None
    plate: BoltPlate | None = None
    segment_m: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "at": "BoltPlace", "steel": "BoltSteel", "grout": "BoltGrout", "dowel": "BoltDowel", "pretension_n": "num", "plate": "BoltPlate", "segment_m": "num"}


@dataclass(kw_only=True)
class BoltDowel(Builder):
    """Resistance of a bolt to shear where it crosses from one block to the next.

    Parameters
    ----------
    stiffness_n_m : float
        Shear force per offset [N/m].
    capacity_n : float
        Largest shear force [N].

    Examples
    --------
    >>> BoltDowel(stiffness_n_m=1.0, capacity_n=1.0).to_ron()
    '(stiffness_n_m: 1.0, capacity_n: 1.0)'
    """

    stiffness_n_m: float
    capacity_n: float
    _kinds: ClassVar[Mapping[str, str]] = {"stiffness_n_m": "num", "capacity_n": "num"}


@dataclass(kw_only=True)
class BoltGrout(Builder):
    """The bond of a bolt.

    Parameters
    ----------
    stiffness_n_m2 : float
        Shear force per length of bolt and slip, k_b [N/m²].
    strength_n_m : float
        Largest shear force per length of bolt, s_b = π D τ of a borehole of diameter D and a bond of strength
        τ [N/m].
    from_m : float, optional
        Where the bonded length begins, from the head [m]; the bolt is free before it. The head is the point
        `from_m` of a `Line`, also where that lies in front of the rock, and of `Rows` the point where the
        bolt meets it. Default: at the head.
    to_m : float, optional
        Where it ends, from the head [m]. Default: at the end.

    Examples
    --------
    >>> BoltGrout(stiffness_n_m2=1.0, strength_n_m=1.0).to_ron()
    '(stiffness_n_m2: 1.0, strength_n_m: 1.0)'
    """

    stiffness_n_m2: float
    strength_n_m: float
    from_m: float | None = None
    to_m: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"stiffness_n_m2": "num", "strength_n_m": "num", "from_m": "num", "to_m": "num"}


class BoltPlace:
    """Where bolts are.

    Examples
    --------
    >>> BoltPlace.Line(from_m=(1.0, 1.0, 1.0), to_m=(1.0, 1.0, 1.0)).to_ron()
    'Line(from_m: (1.0, 1.0, 1.0), to_m: (1.0, 1.0, 1.0))'
    """

    @dataclass(kw_only=True)
    class Line(Builder):
        """One bolt; what of it lies in front of the first block holds nothing.

        Parameters
        ----------
        from_m : Sequence[float]
            Head [m], on a face or in front of it: lengths from the head count from this point.
        to_m : Sequence[float]
            End [m].

        Examples
        --------
        >>> BoltPlace.Line(from_m=(1.0, 1.0, 1.0), to_m=(1.0, 1.0, 1.0)).to_ron()
        'Line(from_m: (1.0, 1.0, 1.0), to_m: (1.0, 1.0, 1.0))'
        """

        from_m: Sequence[float]
        to_m: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"from_m": "(num)", "to_m": "(num)"}
        _variant: ClassVar[str] = "Line"

    @dataclass(kw_only=True)
    class Rows(Builder):
        """Equal bolts over a rectangle, in rows along its first side; each head is where its line from the
        rectangle first meets a block.

        Parameters
        ----------
        corner_m : Sequence[float]
            A corner of the rectangle, on the face or in front of it [m].
        along_m : Sequence[float]
            First side, from the corner [m].
        up_m : Sequence[float]
            Second side, from the corner [m].
        spacing_m : Sequence[float]
            Spacing along both sides [m]; what is left over is shared by both ends.
        direction : Sequence[float]
            Direction of the bolts, into the rock; its length does not matter.
        length_m : float
            Length of a bolt from its head [m].
        staggered : bool, optional
            Whether every second row is shifted by half the spacing; these have one bolt less. Default: no.

        Examples
        --------
        >>> BoltPlace.Rows(corner_m=(1.0, 1.0, 1.0), along_m=(1.0, 1.0, 1.0), up_m=(1.0, 1.0, 1.0), spacing_m=(1.0, 1.0), direction=(1.0, 1.0, 1.0), length_m=1.0).to_ron()
        'Rows(corner_m: (1.0, 1.0, 1.0), along_m: (1.0, 1.0, 1.0), up_m: (1.0, 1.0, 1.0), spacing_m: (1.0, 1.0), direction: (1.0, 1.0, 1.0), length_m: 1.0)'
        """

        corner_m: Sequence[float]
        along_m: Sequence[float]
        up_m: Sequence[float]
        spacing_m: Sequence[float]
        direction: Sequence[float]
        length_m: float
        staggered: bool | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"corner_m": "(num)", "along_m": "(num)", "up_m": "(num)", "spacing_m": "(num)", "direction": "(num)", "length_m": "num", "staggered": "bool"}
        _variant: ClassVar[str] = "Rows"


@dataclass(kw_only=True)
class BoltPlate(Builder):
    """The plate of a bolt.

    Parameters
    ----------
    strength_n : float, optional
        Force at which it gives way [N]. Default: never.

    Examples
    --------
    >>> BoltPlate().to_ron()
    '()'
    """

    strength_n: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"strength_n": "num"}


@dataclass(kw_only=True)
class BoltSteel(Builder):
    """The bar of a bolt.

    Parameters
    ----------
    young_pa : float
        Young's modulus [Pa].
    area_m2 : float
        Area of its section [m²].
    yield_n : float, optional
        Force at which it yields, in tension and compression [N]. Default: never.
    break_strain : float, optional
        Strain at which it breaks, over a gauge length of 5.65 √A as in a tensile test (ISO 6892-1). Default:
        never.

    Examples
    --------
    >>> BoltSteel(young_pa=1.0, area_m2=1.0).to_ron()
    '(young_pa: 1.0, area_m2: 1.0)'
    """

    young_pa: float
    area_m2: float
    yield_n: float | None = None
    break_strain: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"young_pa": "num", "area_m2": "num", "yield_n": "num", "break_strain": "num"}


class BoulderShape:
    """Shape of boulders: convex, of at most 24 faces.

    Examples
    --------
    >>> BoulderShape.Cuboid().to_ron()
    'Cuboid()'
    """

    @dataclass(kw_only=True)
    class Cuboid(Builder):
        """A box.

        Parameters
        ----------
        axes : Sequence[float], optional
            Its edges relative to each other [-]. Default: (1, 1, 1).

        Examples
        --------
        >>> BoulderShape.Cuboid().to_ron()
        'Cuboid()'
        """

        axes: Sequence[float] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"axes": "(num)"}
        _variant: ClassVar[str] = "Cuboid"

    @dataclass(kw_only=True)
    class Ellipsoid(Builder):
        """A ball or ellipsoid of 20 triangles.

        Parameters
        ----------
        axes : Sequence[float], optional
            Its axes relative to each other [-]. Default: (1, 1, 1).

        Examples
        --------
        >>> BoulderShape.Ellipsoid().to_ron()
        'Ellipsoid()'
        """

        axes: Sequence[float] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"axes": "(num)"}
        _variant: ClassVar[str] = "Ellipsoid"

    @dataclass(kw_only=True)
    class Polyhedron(Builder):
        """A convex polyhedron with faces at random, another one for each boulder.

        Parameters
        ----------
        faces : int, optional
            Number of faces, 6 to 24. Default: 14.
        axes : Sequence[float], optional
            Axes of the ellipsoid that its faces are about, relative to each other [-]. Default: (1, 0.8,
            0.65).

        Examples
        --------
        >>> BoulderShape.Polyhedron().to_ron()
        'Polyhedron()'
        """

        faces: int | None = None
        axes: Sequence[float] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"faces": "int", "axes": "(num)"}
        _variant: ClassVar[str] = "Polyhedron"


class BoulderSize:
    """Size of boulders.

    Examples
    --------
    >>> BoulderSize.Diameter(diameter_m=Scatter.Always(1.0)).to_ron()
    'Diameter(diameter_m: Always(1.0))'
    """

    @dataclass(kw_only=True)
    class Diameter(Builder):
        """By the diameter of a sphere of the same volume.

        Parameters
        ----------
        diameter_m : ScatterChoice
            Diameter [m].

        Examples
        --------
        >>> BoulderSize.Diameter(diameter_m=Scatter.Always(1.0)).to_ron()
        'Diameter(diameter_m: Always(1.0))'
        """

        diameter_m: ScatterChoice
        _kinds: ClassVar[Mapping[str, str]] = {"diameter_m": "Scatter"}
        _variant: ClassVar[str] = "Diameter"

    @dataclass(kw_only=True)
    class Volume(Builder):
        """By volume.

        Parameters
        ----------
        volume_m3 : ScatterChoice
            Volume [m³].

        Examples
        --------
        >>> BoulderSize.Volume(volume_m3=Scatter.Always(1.0)).to_ron()
        'Volume(volume_m3: Always(1.0))'
        """

        volume_m3: ScatterChoice
        _kinds: ClassVar[Mapping[str, str]] = {"volume_m3": "Scatter"}
        _variant: ClassVar[str] = "Volume"

    @dataclass(kw_only=True)
    class Mass(Builder):
        """By mass.

        Parameters
        ----------
        mass_kg : ScatterChoice
            Mass [kg].

        Examples
        --------
        >>> BoulderSize.Mass(mass_kg=Scatter.Always(1.0)).to_ron()
        'Mass(mass_kg: Always(1.0))'
        """

        mass_kg: ScatterChoice
        _kinds: ClassVar[Mapping[str, str]] = {"mass_kg": "Scatter"}
        _variant: ClassVar[str] = "Mass"


@dataclass(kw_only=True)
class Boulders(Builder):
    """What falls.

    Parameters
    ----------
    material : str
        Name of their material; its density counts, they do not deform.
    size : BoulderSizeChoice
        Size.
    within : Sequence[float], optional
        Least and largest size, in the unit of the size: the distribution is cut off there. Default: as it is.
    shapes : list[BoulderShapeChoice], optional
        Shapes, of which each boulder has one at random. Default: random polyhedra of 14 faces with axes as 1
        : 0.8 : 0.65.

    Examples
    --------
    >>> Boulders(material="name", size=BoulderSize.Diameter(diameter_m=Scatter.Always(1.0))).to_ron()
    '(material: "name", size: Diameter(diameter_m: Always(1.0)))'
    """

    material: str
    size: BoulderSizeChoice
    within: Sequence[float] | None = None
    shapes: list[BoulderShapeChoice] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"material": "str", "size": "BoulderSize", "within": "(num)", "shapes": "[BoulderShape]"}


class By:
    """How a support is imposed.

    Examples
    --------
    >>> By.Elimination
    'Elimination'
    """

    # The unknowns are taken out of the equations.
    Elimination: ClassVar[Literal["Elimination"]] = "Elimination"

    @dataclass(kw_only=True)
    class Springs(Builder):
        """A spring per node, as in the paper's §4.1.

        Parameters
        ----------
        stiffness_n_m : float, optional
            Stiffness per node [N/m]. Default: 1e6 · E · 1 m.

        Examples
        --------
        >>> By.Springs().to_ron()
        'Springs()'
        """

        stiffness_n_m: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"stiffness_n_m": "num"}
        _variant: ClassVar[str] = "Springs"


@dataclass(kw_only=True)
class Component(Builder):
    """One component of a shaken base.

    Parameters
    ----------
    direction : Sequence[float]
        Its direction; its length does not matter.
    record : Record
        Its record.

    Examples
    --------
    >>> Component(direction=(1.0, 1.0, 1.0), record=Record(file="name")).to_ron()
    '(direction: (1.0, 1.0, 1.0), record: (file: "name"))'
    """

    direction: Sequence[float]
    record: Record
    _kinds: ClassVar[Mapping[str, str]] = {"direction": "(num)", "record": "Record"}


class Contact:
    """Contact between blocks.

    Examples
    --------
    >>> Contact.Off
    'Off'
    """

    # Blocks do not feel each other.
    Off: ClassVar[Literal["Off"]] = "Off"

    @dataclass(kw_only=True)
    class Potential(Builder):
        """A contact potential: energy of the volume that blocks share.

        Parameters
        ----------
        penalty_pa : float, optional
            Normal penalty k_n [Pa]. With `Smooth`, contact is as compliant as E L₀/(2 k_n) of rock. The error
            of settlements and waves is about that length relative to the block size; rebound hardly depends
            on it. Nor does sliding, except near the limit of friction, where blocks also slip while they sink
            in: a penalty ten times as large shows by how much. Default: chosen from the size of blocks, their
            loads and speeds so that contact is at most `depth_ratio` deep, and said with its reason. Under
            loads that press soft or large blocks deeper than that even where contact is as stiff as half a
            block, it is as stiff as that, and the reason says how deep blocks then overlap.
        depth_ratio : float, optional
            Depth of contact at rest over the size of small blocks, from which `penalty_pa` is chosen where it
            is left out. Default: 1e-4.
        potential : PotentialChoice, optional
            The contact potential inside a block. Default: `Element`, the paper's.
        friction : Friction, optional
            Friction between all blocks. Default: none.
        restitution : float, optional
            Coefficient of restitution e of all contacts, from 0 to 1: speed at which two blocks part after a
            central impact over that at which they met, whatever the penalty, where the steps resolve it; near
            0 blocks that deform part faster. Below 1, what rings comes to rest; 0 counts as 0.005. Needs
            `contact_at: Predicted`. Default: 1, undamped.
        shear_restitution : float, optional
            Coefficient of restitution along the face, from 0 to 1: speed that half an oscillation on a shear
            spring leaves, over that before, while the spring sticks. Needs friction with
            `shear_penalty_pa_m`. Default: springs are damped as contact is along its normal.
        friction_tolerance : float, optional
            Tolerance of friction on velocities: change of the friction of a face that does not matter, as a
            part of the largest μN on its blocks, from 1e-10 to 1e-2. It is an error of slips, which the next
            step finds anew. Piles of rigid cubes visit their faces a quarter to a half as often with 1e-4 as
            they do without it. `contact_at: End` has a tolerance of its own. Default: 1e-7, and more with
            more than 1000 faces in contact.
        material_pairs : list[MaterialPair], optional
            Friction between blocks of two materials, in place of `friction`; a later entry counts more.
            Default: none.
        rock_joints : list[JointLaw], optional
            Friction on the faces of joints that cut rock, in place of all other; a later entry counts more.
            Default: none.
        memory : MemoryChoice, optional
            The owner of friction history. Default: `Body`.

        Examples
        --------
        >>> Contact.Potential().to_ron()
        'Potential()'
        """

        penalty_pa: float | None = None
        depth_ratio: float | None = None
        potential: PotentialChoice | None = None
        friction: Friction | None = None
        restitution: float | None = None
        shear_restitution: float | None = None
        friction_tolerance: float | None = None
        material_pairs: list[MaterialPair] | None = None
        rock_joints: list[JointLaw] | None = None
        memory: MemoryChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"penalty_pa": "num", "depth_ratio": "num", "potential": "Potential", "friction": "Friction", "restitution": "num", "shear_restitution": "num", "friction_tolerance": "num", "material_pairs": "[MaterialPair]", "rock_joints": "[JointLaw]", "memory": "Memory"}
        _variant: ClassVar[str] = "Potential"


class ContactAt:
    """Where in a step contact is taken.

    Examples
    --------
    >>> ContactAt.Predicted
    'Predicted'
    """

    # At the positions that the integrator predicts; a step must be short: ω_c Δt < 2.
    Predicted: ClassVar[Literal["Predicted"]] = "Predicted"

    @dataclass(kw_only=True)
    class End(Builder):
        """At the end of the step, solved for: stable for any step, and damps what a step does not resolve.

        Parameters
        ----------
        tolerance : float, optional
            Largest misfit of contact forces over the largest of contact forces and loads. Default: 1e-8.
        most_iterations : int, optional
            Evaluations of contact after which a run stops. Default: 100.

        Examples
        --------
        >>> ContactAt.End().to_ron()
        'End()'
        """

        tolerance: float | None = None
        most_iterations: int | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"tolerance": "num", "most_iterations": "int"}
        _variant: ClassVar[str] = "End"


@dataclass(kw_only=True)
class CountingLine(Builder):
    """A line on the map at which boulders are counted.

    Parameters
    ----------
    name : str
        Its name.
    points_m : Sequence[Sequence[float]]
        Its corners on the map (x, y) [m].

    Examples
    --------
    >>> CountingLine(name="name", points_m=[(1.0, 1.0, 1.0)]).to_ron()
    '(name: "name", points_m: [(1.0, 1.0, 1.0)])'
    """

    name: str
    points_m: Sequence[Sequence[float]]
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "points_m": "[(num)]"}


@dataclass(kw_only=True)
class Damping(Builder):
    """Rayleigh damping: a mode of frequency ω [rad/s] is damped by a/2ω + b ω/2 of critical.

    Parameters
    ----------
    mass_per_s : float, optional
        a [1/s], on mass: drags on every motion, that of a block as a whole, too. Default: 0.
    stiffness_s : float, optional
        b [s], on stiffness: resists deformation. Default: 0.

    Examples
    --------
    >>> Damping().to_ron()
    '()'
    """

    mass_per_s: float | None = None
    stiffness_s: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"mass_per_s": "num", "stiffness_s": "num"}


@dataclass(kw_only=True)
class Dilation(Builder):
    """Dilation of a joint: v = tan ψ min(|u_p|, u_zd), u_p being its slip beyond the stretch of its spring;
    it closes again where slip is reversed.

    Faces of blocks are moved out by v before contact is found between them, so that blocks are pushed apart.

    Parameters
    ----------
    psi_deg : float
        Dilation angle ψ [°], at most the friction angle, also the residual one: a joint cannot give energy.
    to_slip_m : float
        Slip u_zd at which dilation ends [m].

    Examples
    --------
    >>> Dilation(psi_deg=1.0, to_slip_m=1.0).to_ron()
    '(psi_deg: 1.0, to_slip_m: 1.0)'
    """

    psi_deg: float
    to_slip_m: float
    _kinds: ClassVar[Mapping[str, str]] = {"psi_deg": "num", "to_slip_m": "num"}


class DiscRule:
    """Which blocks a disc cuts.

    Its plane cuts a block in a section, of which the disc covers a part.

    Examples
    --------
    >>> DiscRule.Share(1.0).to_ron()
    'Share(1.0)'
    """

    @dataclass
    class Share(Builder):
        """Blocks of whose section the disc covers at least this part of the area, 0 to 1.

        Parameters
        ----------
        value : float
            Blocks of whose section the disc covers at least this part of the area, 0 to 1.

        Examples
        --------
        >>> DiscRule.Share(1.0).to_ron()
        'Share(1.0)'
        """

        value: float
        _kinds: ClassVar[Mapping[str, str]] = {"value": "num"}
        _variant: ClassVar[str] = "Share"

    # Blocks that the disc meets, however little of the section it covers.
    Meets: ClassVar[Literal["Meets"]] = "Meets"
    # Blocks of which it covers the whole section: no cut is larger than the disc.
    Covers: ClassVar[Literal["Covers"]] = "Covers"


class Discontinuity:
    """Something that cuts rock.

    x is east, y north, z up; dip is below the plane of x and y, whatever gravity is, its direction clockwise
    from north.

    Examples
    --------
    >>> Discontinuity.Set(name="name", dip_deg=1.0, dip_direction_deg=1.0, spacing_m=1.0).to_ron()
    'Set(name: "name", dip_deg: 1.0, dip_direction_deg: 1.0, spacing_m: 1.0)'
    """

    @dataclass(kw_only=True)
    class Set(Builder):
        """Planes of one orientation, one spacing apart.

        Parameters
        ----------
        name : str
            Name of the node sets on it.
        dip_deg : float
            Dip, 0 to 90 [°].
        dip_direction_deg : float
            Dip direction [°].
        spacing_m : float
            Mean distance of planes along their normal [m].
        origin_m : Sequence[float], optional
            A point of one of the planes [m]. Default: (0, 0, 0).
        persistence : float, optional
            Probability that a plane cuts a block that it crosses. Default: 1.
        orientation_scatter : OrientationScatterChoice, optional
            Scatter of orientations. Default: none.
        spacing_scatter : SpacingScatterChoice, optional
            Scatter of distances. Default: none.

        Examples
        --------
        >>> Discontinuity.Set(name="name", dip_deg=1.0, dip_direction_deg=1.0, spacing_m=1.0).to_ron()
        'Set(name: "name", dip_deg: 1.0, dip_direction_deg: 1.0, spacing_m: 1.0)'
        """

        name: str
        dip_deg: float
        dip_direction_deg: float
        spacing_m: float
        origin_m: Sequence[float] | None = None
        persistence: float | None = None
        orientation_scatter: OrientationScatterChoice | None = None
        spacing_scatter: SpacingScatterChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "dip_deg": "num", "dip_direction_deg": "num", "spacing_m": "num", "origin_m": "(num)", "persistence": "num", "orientation_scatter": "OrientationScatter", "spacing_scatter": "SpacingScatter"}
        _variant: ClassVar[str] = "Set"

    @dataclass(kw_only=True)
    class Plane(Builder):
        """One plane through all of the rock.

        Parameters
        ----------
        name : str
            Name of the node sets on it.
        dip_deg : float
            Dip, 0 to 90 [°].
        dip_direction_deg : float
            Dip direction [°].
        point_m : Sequence[float]
            A point of it [m].

        Examples
        --------
        >>> Discontinuity.Plane(name="name", dip_deg=1.0, dip_direction_deg=1.0, point_m=(1.0, 1.0, 1.0)).to_ron()
        'Plane(name: "name", dip_deg: 1.0, dip_direction_deg: 1.0, point_m: (1.0, 1.0, 1.0))'
        """

        name: str
        dip_deg: float
        dip_direction_deg: float
        point_m: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "dip_deg": "num", "dip_direction_deg": "num", "point_m": "(num)"}
        _variant: ClassVar[str] = "Plane"

    @dataclass(kw_only=True)
    class Disc(Builder):
        """A disc.

        A block is cut through and through or not at all, by the rule.

        Parameters
        ----------
        name : str
            Name of the node sets on it.
        dip_deg : float
            Dip, 0 to 90 [°].
        dip_direction_deg : float
            Dip direction [°].
        center_m : Sequence[float]
            Centre [m].
        radius_m : float
            Radius [m].
        rule : DiscRuleChoice, optional
            Which blocks it cuts. Default: `Share(0.5)`.

        Examples
        --------
        >>> Discontinuity.Disc(name="name", dip_deg=1.0, dip_direction_deg=1.0, center_m=(1.0, 1.0, 1.0), radius_m=1.0).to_ron()
        'Disc(name: "name", dip_deg: 1.0, dip_direction_deg: 1.0, center_m: (1.0, 1.0, 1.0), radius_m: 1.0)'
        """

        name: str
        dip_deg: float
        dip_direction_deg: float
        center_m: Sequence[float]
        radius_m: float
        rule: DiscRuleChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "dip_deg": "num", "dip_direction_deg": "num", "center_m": "(num)", "radius_m": "num", "rule": "DiscRule"}
        _variant: ClassVar[str] = "Disc"

    @dataclass(kw_only=True)
    class Discs(Builder):
        """Discs from a table, a discrete fracture network (DFN).

        They cut in the order of their radius, largest first, whatever the order of the rows.

        Parameters
        ----------
        file : str
            CSV file with the columns `dip_deg`, `dip_direction_deg`, `x_m`, `y_m`, `z_m`, `radius_m` and
            `set`, which may be left out; its path is relative to the scene file.
        name : str, optional
            Name of the node sets on discs whose row names no set; those of others go by their set. Default:
            `discs`.
        rule : DiscRuleChoice, optional
            Which blocks they cut. Default: `Share(0.5)`.

        Examples
        --------
        >>> Discontinuity.Discs(file="name").to_ron()
        'Discs(file: "name")'
        """

        file: str
        name: str | None = None
        rule: DiscRuleChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "file": "str", "rule": "DiscRule"}
        _variant: ClassVar[str] = "Discs"


class Domain:
    """Rock before it is cut.

    Its faces give the blocks their node sets, as joints do.

    Examples
    --------
    >>> Domain.Box(min_m=(1.0, 1.0, 1.0), max_m=(1.0, 1.0, 1.0)).to_ron()
    'Box(min_m: (1.0, 1.0, 1.0), max_m: (1.0, 1.0, 1.0))'
    """

    @dataclass(kw_only=True)
    class Box(Builder):
        """A box; faces `x_min` to `z_max`.

        Parameters
        ----------
        min_m : Sequence[float]
            Lowest corner [m].
        max_m : Sequence[float]
            Highest corner [m].

        Examples
        --------
        >>> Domain.Box(min_m=(1.0, 1.0, 1.0), max_m=(1.0, 1.0, 1.0)).to_ron()
        'Box(min_m: (1.0, 1.0, 1.0), max_m: (1.0, 1.0, 1.0))'
        """

        min_m: Sequence[float]
        max_m: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"min_m": "(num)", "max_m": "(num)"}
        _variant: ClassVar[str] = "Box"

    @dataclass(kw_only=True)
    class Column(Builder):
        """An outline drawn along an axis; faces `side_0` from corner 0 to 1, …, `start` and `end`.

        Parameters
        ----------
        outline_m : Sequence[Sequence[float]]
            Corners in order, either way round, convex or not [m]: (y, z) along `X`, (x, z) along `Y`, (x, y)
            along `Z`.
        start_m : float
            Where it starts on the axis [m].
        end_m : float
            Where it ends [m].
        axis : AxisChoice, optional
            The axis. Default: `Z`.

        Examples
        --------
        >>> Domain.Column(outline_m=[(1.0, 1.0, 1.0)], start_m=1.0, end_m=1.0).to_ron()
        'Column(outline_m: [(1.0, 1.0, 1.0)], start_m: 1.0, end_m: 1.0)'
        """

        outline_m: Sequence[Sequence[float]]
        start_m: float
        end_m: float
        axis: AxisChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"outline_m": "[(num)]", "axis": "Axis", "start_m": "num", "end_m": "num"}
        _variant: ClassVar[str] = "Column"

    @dataclass(kw_only=True)
    class Polyhedron(Builder):
        """A body under flat faces; `face_0`, `face_1`, ….

        Parameters
        ----------
        corners_m : Sequence[Sequence[float]]
            Corners [m].
        faces : Sequence[Sequence[int]]
            Corners of each face, counter-clockwise seen from outside, counted from 0.

        Examples
        --------
        >>> Domain.Polyhedron(corners_m=[(1.0, 1.0, 1.0)], faces=[[1]]).to_ron()
        'Polyhedron(corners_m: [(1.0, 1.0, 1.0)], faces: [[1]])'
        """

        corners_m: Sequence[Sequence[float]]
        faces: Sequence[Sequence[int]]
        _kinds: ClassVar[Mapping[str, str]] = {"corners_m": "[(num)]", "faces": "[[int]]"}
        _variant: ClassVar[str] = "Polyhedron"

    @dataclass(kw_only=True)
    class File(Builder):
        """Rock under a closed surface in a file, STL, OBJ, VTK's `.vtp` or `.vtk`; its faces have the names
        that the file gives.

        Parameters
        ----------
        file : str
            Path, relative to the scene file.
        unit_m : float, optional
            Metres per unit of the file. Default: 1.

        Examples
        --------
        >>> Domain.File(file="name").to_ron()
        'File(file: "name")'
        """

        file: str
        unit_m: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"file": "str", "unit_m": "num"}
        _variant: ClassVar[str] = "File"

    @dataclass(kw_only=True)
    class Terrain(Builder):
        """Rock under a grid of heights; faces `terrain`, `base` and `side`.

        Parameters
        ----------
        origin_m : Sequence[float]
            Place of the first height (x, y) [m].
        step_m : Sequence[float]
            Distance of heights along x and y [m].
        heights_m : Sequence[Sequence[float]]
            Rows of heights along x, one row after the other along y [m].
        base_m : float
            Height of the base [m].

        Examples
        --------
        >>> Domain.Terrain(origin_m=(1.0, 1.0), step_m=(1.0, 1.0), heights_m=[[1.0]], base_m=1.0).to_ron()
        'Terrain(origin_m: (1.0, 1.0), step_m: (1.0, 1.0), heights_m: [[1.0]], base_m: 1.0)'
        """

        origin_m: Sequence[float]
        step_m: Sequence[float]
        heights_m: Sequence[Sequence[float]]
        base_m: float
        _kinds: ClassVar[Mapping[str, str]] = {"origin_m": "(num)", "step_m": "(num)", "heights_m": "[[num]]", "base_m": "num"}
        _variant: ClassVar[str] = "Terrain"

    @dataclass(kw_only=True)
    class TerrainFile(Builder):
        """Rock under heights in a file: an ESRI ASCII grid (`.asc`), points of a regular grid (`.xyz`,
        `.txt`, `.csv`), a GeoTIFF (`.tif`, `.tiff`), or a surface of triangles (`.stl`), sampled at a two-
        hundredth of its longer side; faces as of `Terrain`.

        Cells with a corner without height are left out. A first line of names (x, east; y, north; z, height,
        …) says which columns of points are which; without one they are x, y, z.

        Parameters
        ----------
        file : str
            Path, relative to the scene file.
        base_m : float
            Height of the base [m].
        origin_m : Sequence[float], optional
            Point (x, y) of the map that is (0, 0) in the scene [m]. Default: (0, 0).

        Examples
        --------
        >>> Domain.TerrainFile(file="name", base_m=1.0).to_ron()
        'TerrainFile(file: "name", base_m: 1.0)'
        """

        file: str
        base_m: float
        origin_m: Sequence[float] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"file": "str", "origin_m": "(num)", "base_m": "num"}
        _variant: ClassVar[str] = "TerrainFile"


@dataclass(kw_only=True)
class Excavation(Builder):
    """A space that stages of construction excavate: an outline drawn along an axis.

    Blocks that it meets are cut along its border, and those inside are named after it, `heading_0001`,
    `heading_0002`, …, so that a stage can take out `heading_*`. The faces of these cuts, and only these, are
    glued by bonds that no stress breaks: the rock behaves as before, until one side is taken out.

    Parameters
    ----------
    name : str
        Its name, unique among all excavations, rocks and joints.
    outline_m : Sequence[Sequence[float]]
        Corners in order, either way round, convex or not [m]: (y, z) along `X`, (x, z) along `Y`, (x, y)
        along `Z`.
    start_m : float
        Where it starts on the axis [m].
    end_m : float
        Where it ends [m].
    axis : AxisChoice, optional
        The axis. Default: `Z`.
    glue_pa_m : float, optional
        Stiffness of the glue [Pa/m]. Default: that of normal contact there.

    Examples
    --------
    >>> Excavation(name="name", outline_m=[(1.0, 1.0, 1.0)], start_m=1.0, end_m=1.0).to_ron()
    '(name: "name", outline_m: [(1.0, 1.0, 1.0)], start_m: 1.0, end_m: 1.0)'
    """

    name: str
    outline_m: Sequence[Sequence[float]]
    start_m: float
    end_m: float
    axis: AxisChoice | None = None
    glue_pa_m: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "outline_m": "[(num)]", "axis": "Axis", "start_m": "num", "end_m": "num", "glue_pa_m": "num"}


@dataclass(kw_only=True)
class FactorRow(Builder):
    """One row of a load's factor.

    Parameters
    ----------
    time_s : float
        Time [s].
    factor : float
        Factor [-].

    Examples
    --------
    >>> FactorRow(time_s=1.0, factor=1.0).to_ron()
    '(time_s: 1.0, factor: 1.0)'
    """

    time_s: float
    factor: float
    _kinds: ClassVar[Mapping[str, str]] = {"time_s": "num", "factor": "num"}


class Field:
    """A field of a frame.

    Examples
    --------
    >>> Field.Displacement
    'Displacement'
    """

    # Displacement since the start per node [m].
    Displacement: ClassVar[Literal["Displacement"]] = "Displacement"
    # Velocity per node [m/s].
    Velocity: ClassVar[Literal["Velocity"]] = "Velocity"
    # Acceleration per node [m/s²].
    Acceleration: ClassVar[Literal["Acceleration"]] = "Acceleration"
    # Cauchy stress per tetrahedron [Pa], tension positive: XX YY ZZ XY YZ XZ.
    Stress: ClassVar[Literal["Stress"]] = "Stress"
    # Von Mises stress per tetrahedron [Pa].
    VonMises: ClassVar[Literal["VonMises"]] = "VonMises"
    # Contact force per node [N], friction included, of the last step.
    ContactForce: ClassVar[Literal["ContactForce"]] = "ContactForce"
    # Contact force over the surface of a node [Pa].
    ContactTraction: ClassVar[Literal["ContactTraction"]] = "ContactTraction"
    # Per node: 0 no contact, 1 held by friction, 2 at least one facet slides.
    FrictionState: ClassVar[Literal["FrictionState"]] = "FrictionState"
    # Number of the block per tetrahedron, from 0 in the order of the blocks.
    BlockId: ClassVar[Literal["BlockId"]] = "BlockId"
    # Number of the material per tetrahedron, from 0 in the order of `materials`.
    Material: ClassVar[Literal["Material"]] = "Material"


class FieldFormat:
    """How a frame is written.

    Examples
    --------
    >>> FieldFormat.Compressed
    'Compressed'
    """

    # Arrays appended as raw data, packed by zlib: the smallest.
    Compressed: ClassVar[Literal["Compressed"]] = "Compressed"
    # Arrays appended as raw data: the quickest.
    Appended: ClassVar[Literal["Appended"]] = "Appended"
    # Arrays inline as base 64: text from end to end, the largest.
    Base64: ClassVar[Literal["Base64"]] = "Base64"


class Fill:
    """How a polyhedron is filled with tetrahedra.

    Examples
    --------
    >>> Fill.Fewest
    'Fewest'
    """

    # As few as there can be; no node inside. Blocks of a rock with more than 13 faces are filled as with
    # `Centre` where contact is `Smooth` or `Closure`.
    Fewest: ClassVar[Literal["Fewest"]] = "Fewest"
    # A star from one node at the centroid.
    Centre: ClassVar[Literal["Centre"]] = "Centre"

    @dataclass(kw_only=True)
    class Size(Builder):
        """Edges of about one length.

        Parameters
        ----------
        size_m : float
            The length [m].
        finer : list[Grading], optional
            Where to be finer. Default: nowhere.

        Examples
        --------
        >>> Fill.Size(size_m=1.0).to_ron()
        'Size(size_m: 1.0)'
        """

        size_m: float
        finer: list[Grading] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"size_m": "num", "finer": "[Grading]"}
        _variant: ClassVar[str] = "Size"

    @dataclass(kw_only=True)
    class TetGen(Builder):
        """By TetGen, for surfaces as rough as they come; a build with the feature `tetgen` only, which is
        under the AGPL.

        Parameters
        ----------
        size_m : float
            Longest edge, about [m].

        Examples
        --------
        >>> Fill.TetGen(size_m=1.0).to_ron()
        'TetGen(size_m: 1.0)'
        """

        size_m: float
        _kinds: ClassVar[Mapping[str, str]] = {"size_m": "num"}
        _variant: ClassVar[str] = "TetGen"


@dataclass(kw_only=True)
class Force(Builder):
    """A force on a block, constant in direction: on a point, or through the mass centre.

    Parameters
    ----------
    block : str
        Name of the block, or of many as in a support; each takes the whole force.
    force_n : Sequence[float]
        Force [N].
    at_m : Sequence[float], optional
        The point [m], whose force the corners of its tetrahedron share (outside of the block, the nearest
        node takes it; farther than a tenth of the diagonal of the block's box from that box, it is refused);
        of many blocks, those that have it take the force. Default: through the mass centre, shared among all
        nodes by volume.
    factor : list[FactorRow], optional
        Factor over time, linear between rows and constant outside. Default: 1.

    Examples
    --------
    >>> Force(block="name", force_n=(1.0, 1.0, 1.0)).to_ron()
    '(block: "name", force_n: (1.0, 1.0, 1.0))'
    """

    block: str
    force_n: Sequence[float]
    at_m: Sequence[float] | None = None
    factor: list[FactorRow] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "at_m": "(num)", "force_n": "(num)", "factor": "[FactorRow]"}


@dataclass(kw_only=True)
class FractureEnergy(Builder):
    """Energies that it takes to break a joint: its stress falls linearly to nothing at an opening of 2
    G_I/σ_t or a slip of 2 G_II/c.

    Parameters
    ----------
    tension_j_m2 : float
        Fracture energy G_I in tension [J/m²], at least σ_t²/2k_s.
    shear_j_m2 : float
        Fracture energy G_II in shear without normal stress [J/m²], at least c²/2k_s.

    Examples
    --------
    >>> FractureEnergy(tension_j_m2=1.0, shear_j_m2=1.0).to_ron()
    '(tension_j_m2: 1.0, shear_j_m2: 1.0)'
    """

    tension_j_m2: float
    shear_j_m2: float
    _kinds: ClassVar[Mapping[str, str]] = {"tension_j_m2": "num", "shear_j_m2": "num"}


@dataclass(kw_only=True)
class Friction(Builder):
    """Friction of a joint.

    Without `shear_penalty_pa_m` it acts on velocities: at once when blocks slide, and without any
    displacement while they stick. With it, shear is a spring (the paper's eqs (17)–(19)), and may hold
    together.

    Parameters
    ----------
    friction_deg : float
        Friction angle φ [°]; μ = tan φ.
    shear_penalty_pa_m : float, optional
        Shear penalty k_s [Pa/m]; the paper's "0.1 E" is 0.1 · E / 1 m. Default: no spring.
    cohesion_pa : float, optional
        Cohesion c [Pa]: shear strength max(0, c + σ tan φ), compression positive, until it breaks for good;
        needs `shear_penalty_pa_m`. Default: 0.
    tension_pa : float, optional
        Tensile strength σ_t [Pa], until the joint opens; beyond c/tan φ it holds only without shear; needs
        `shear_penalty_pa_m`. Default: 0.
    residual : Residual, optional
        Values to which friction and cohesion fall while the joint slips, instead of cohesion that breaks at
        once; with the same values as the peak the joint is perfectly plastic. Needs `shear_penalty_pa_m`.
        Default: none.
    roughness : Roughness, optional
        Roughness after Barton and Bandis: shear strength σ tan(φ_r + JRC log₁₀(JCS/σ)), `friction_deg` being
        the residual angle φ_r, and the whole angle at most 70°. Needs `shear_penalty_pa_m`, and no cohesion,
        tension or `residual`. Default: none.
    fracture : FractureEnergy, optional
        Energies that the joint takes to break, in place of bonds that break at once: tension and cohesion
        fall gradually, in mixed mode (δ_n/δ_nc)² + (δ_s/δ_sc)² = 1, and friction acts on what is broken.
        Needs `shear_penalty_pa_m`, cohesion and tension, and no `residual`, `roughness` or `dilation`.
        Default: none.
    dilation : Dilation, optional
        How the joint opens while it slips. Needs `shear_penalty_pa_m`, the potential `Smooth` or `Closure`,
        `memory: Body`, and no `roughness`, which dilates by half of its own angle. Default: none.

    Examples
    --------
    >>> Friction(friction_deg=1.0).to_ron()
    '(friction_deg: 1.0)'
    """

    friction_deg: float
    shear_penalty_pa_m: float | None = None
    cohesion_pa: float | None = None
    tension_pa: float | None = None
    residual: Residual | None = None
    roughness: Roughness | None = None
    fracture: FractureEnergy | None = None
    dilation: Dilation | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"friction_deg": "num", "shear_penalty_pa_m": "num", "cohesion_pa": "num", "tension_pa": "num", "residual": "Residual", "roughness": "Roughness", "fracture": "FractureEnergy", "dilation": "Dilation"}


@dataclass(kw_only=True)
class Grading(Builder):
    """Shorter edges towards a place, growing with the distance from it.

    Parameters
    ----------
    towards : TowardsChoice
        The place, in the coordinates of the shape before it is turned, or of the rock.
    size_m : float
        Length of edges there [m].
    growth : float, optional
        Growth of the length per metre of distance. Default: 0.3.

    Examples
    --------
    >>> Grading(towards=Towards.Point((1.0, 1.0, 1.0)), size_m=1.0).to_ron()
    '(towards: Point((1.0, 1.0, 1.0)), size_m: 1.0)'
    """

    towards: TowardsChoice
    size_m: float
    growth: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"towards": "Towards", "size_m": "num", "growth": "num"}


class Ground:
    """The ground of a rockfall: heights on a regular grid, two triangles in each cell.

    Examples
    --------
    >>> Ground.File(file="name").to_ron()
    'File(file: "name")'
    """

    @dataclass(kw_only=True)
    class File(Builder):
        """Heights in a file: an ESRI ASCII grid (`.asc`), points of a regular grid (`.xyz`, `.txt`, `.csv`),
        a GeoTIFF (`.tif`, `.tiff`), or a surface of triangles (`.stl`).

        A first line of names (x, east; y, north; z, height, …) says which columns of points are which;
        without one they are x, y, z.

        Parameters
        ----------
        file : str
            Path, relative to the scene file.
        origin_m : Sequence[float], optional
            Point (x, y) of the map that is (0, 0) in the scene [m]. Default: (0, 0).
        sample_m : float, optional
            Distance of the heights that a surface of triangles is sampled at by vertical rays [m]; files of
            heights have their own. Default: a two-hundredth of the longer side of the surface.

        Examples
        --------
        >>> Ground.File(file="name").to_ron()
        'File(file: "name")'
        """

        file: str
        origin_m: Sequence[float] | None = None
        sample_m: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"file": "str", "origin_m": "(num)", "sample_m": "num"}
        _variant: ClassVar[str] = "File"

    @dataclass(kw_only=True)
    class Heights(Builder):
        """Heights that are written out.

        Parameters
        ----------
        origin_m : Sequence[float]
            Place of the first height (x, y) [m].
        step_m : Sequence[float]
            Distance of heights along x and y [m].
        heights_m : Sequence[Sequence[float]]
            Rows of heights along x, one row after the other along y [m].

        Examples
        --------
        >>> Ground.Heights(origin_m=(1.0, 1.0), step_m=(1.0, 1.0), heights_m=[[1.0]]).to_ron()
        'Heights(origin_m: (1.0, 1.0), step_m: (1.0, 1.0), heights_m: [[1.0]])'
        """

        origin_m: Sequence[float]
        step_m: Sequence[float]
        heights_m: Sequence[Sequence[float]]
        _kinds: ClassVar[Mapping[str, str]] = {"origin_m": "(num)", "step_m": "(num)", "heights_m": "[[num]]"}
        _variant: ClassVar[str] = "Heights"


@dataclass(kw_only=True)
class GroundLaw(Builder):
    """How ground answers to a boulder.

    Parameters
    ----------
    restitution : ScatterChoice
        Coefficient of restitution e from 0 to 1: speed along the normal of the ground after a central impact
        over that before.
    friction_deg : ScatterChoice
        Friction angle φ between boulder and ground [°]; what a boulder loses along the ground follows from it
        and from its spin.

    Examples
    --------
    >>> GroundLaw(restitution=Scatter.Always(1.0), friction_deg=Scatter.Always(1.0)).to_ron()
    '(restitution: Always(1.0), friction_deg: Always(1.0))'
    """

    restitution: ScatterChoice
    friction_deg: ScatterChoice
    _kinds: ClassVar[Mapping[str, str]] = {"restitution": "Scatter", "friction_deg": "Scatter"}


@dataclass(kw_only=True)
class GroundLayer(Builder):
    """A layer of level ground.

    Parameters
    ----------
    material : str
        Its material.
    top_m : Sequence[float]
        A place on its upper border [m]; only its height counts.

    Examples
    --------
    >>> GroundLayer(material="name", top_m=(1.0, 1.0, 1.0)).to_ron()
    '(material: "name", top_m: (1.0, 1.0, 1.0))'
    """

    material: str
    top_m: Sequence[float]
    _kinds: ClassVar[Mapping[str, str]] = {"material": "str", "top_m": "(num)"}


class Hold:
    """The constraint of a support.

    Examples
    --------
    >>> Hold.Fixed
    'Fixed'
    """

    # All three components.
    Fixed: ClassVar[Literal["Fixed"]] = "Fixed"
    # The component along the normal of the region's plane.
    Normal: ClassVar[Literal["Normal"]] = "Normal"

    @dataclass
    class Direction(Builder):
        """The component along a direction.

        Parameters
        ----------
        value : Sequence[float]
            The component along a direction.

        Examples
        --------
        >>> Hold.Direction((1.0, 1.0, 1.0)).to_ron()
        'Direction((1.0, 1.0, 1.0))'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "(num)"}
        _variant: ClassVar[str] = "Direction"

    @dataclass
    class Motion(Builder):
        """All three components follow a displacement: zero up to the first row, linear between rows, constant
        after the last.

        Parameters
        ----------
        value : list[MotionRow]
            All three components follow a displacement: zero up to the first row, linear between rows,
            constant after the last.

        Examples
        --------
        >>> Hold.Motion([MotionRow(time_s=1.0, displacement_m=(1.0, 1.0, 1.0))]).to_ron()
        'Motion([(time_s: 1.0, displacement_m: (1.0, 1.0, 1.0))])'
        """

        value: list[MotionRow]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "[MotionRow]"}
        _variant: ClassVar[str] = "Motion"

    @dataclass(kw_only=True)
    class Acceleration(Builder):
        """All three components follow a record of accelerations, from rest: a shaken base.

        Acceleration is linear between rows and zero after the last.

        Parameters
        ----------
        file : str
            CSV file with the columns `time_s` and `acceleration_m_s2`; its path counts from the scene file.
        direction : Sequence[float]
            Direction of the motion; its length does not matter.
        factor : float, optional
            Factor on the accelerations. Default: 1.

        Examples
        --------
        >>> Hold.Acceleration(file="name", direction=(1.0, 1.0, 1.0)).to_ron()
        'Acceleration(file: "name", direction: (1.0, 1.0, 1.0))'
        """

        file: str
        direction: Sequence[float]
        factor: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"file": "str", "direction": "(num)", "factor": "num"}
        _variant: ClassVar[str] = "Acceleration"

    @dataclass
    class Shaking(Builder):
        """All three components follow records of accelerations, from rest, which add up: a base that is
        shaken along one, two or three directions.

        Parameters
        ----------
        value : list[Component]
            All three components follow records of accelerations, from rest, which add up: a base that is
            shaken along one, two or three directions.

        Examples
        --------
        >>> Hold.Shaking([Component(direction=(1.0, 1.0, 1.0), record=Record(file="name"))]).to_ron()
        'Shaking([(direction: (1.0, 1.0, 1.0), record: (file: "name"))])'
        """

        value: list[Component]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "[Component]"}
        _variant: ClassVar[str] = "Shaking"


@dataclass(kw_only=True)
class InSitu(Builder):
    """A stress that changes linearly over the scene, σ₀ = σ + Σ g (n·(x − at)).

    Parameters
    ----------
    stress_pa : Stress
        The stress at `at_m` [Pa], tension positive.
    at_m : Sequence[float], optional
        Where it is that [m]. Default: (0, 0, 0).
    gradients : list[StressGradient], optional
        How it changes along directions; several add up. Default: not at all.

    Examples
    --------
    >>> InSitu(stress_pa=Stress()).to_ron()
    '(stress_pa: ())'
    """

    stress_pa: Stress
    at_m: Sequence[float] | None = None
    gradients: list[StressGradient] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"stress_pa": "Stress", "at_m": "(num)", "gradients": "[StressGradient]"}


@dataclass(kw_only=True)
class IncidentWave(Builder):
    """A plane wave that arrives from beyond quiet faces.

    Parameters
    ----------
    wave : WaveKindChoice
        Its kind.
    record : Record
        Its motion over time.
    motion : RecordedAsChoice, optional
        Where the record was measured. Default: `Upgoing`.
    along : Sequence[float], optional
        Direction in which it travels; its length does not matter. Default: against gravity, (0, 0, 1)
        without.
    from_m : Sequence[float], optional
        A place that it passes at the times of the record [m]. Default: the node of these faces that it meets
        first.
    ground_m : Sequence[float], optional
        A place on level ground, across the way of the wave, that sends it back [m]: its echo arrives at these
        faces, too. For faces at the sides of uniform ground, which then move as the ground far away does, and
        for a record `Within`. Default: no echo.

    Examples
    --------
    >>> IncidentWave(wave=WaveKind.P, record=Record(file="name")).to_ron()
    '(wave: P, record: (file: "name"))'
    """

    wave: WaveKindChoice
    record: Record
    motion: RecordedAsChoice | None = None
    along: Sequence[float] | None = None
    from_m: Sequence[float] | None = None
    ground_m: Sequence[float] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"wave": "WaveKind", "record": "Record", "motion": "RecordedAs", "along": "(num)", "from_m": "(num)", "ground_m": "(num)"}


class Integrator:
    """Choice of time integrator.

    Examples
    --------
    >>> Integrator.Midpoint().to_ron()
    'Midpoint()'
    """

    @dataclass(kw_only=True)
    class Midpoint(Builder):
        """Second order; elasticity weighted by θ, contact at x + ½ Δt v.

        Parameters
        ----------
        theta : float, optional
            Weight θ of the end of the step, ½ (no damping) to 1. Default: 0.5.

        Examples
        --------
        >>> Integrator.Midpoint().to_ron()
        'Midpoint()'
        """

        theta: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"theta": "num"}
        _variant: ClassVar[str] = "Midpoint"

    @dataclass(kw_only=True)
    class GeneralizedAlpha(Builder):
        """Second order; damps elastic modes far above 1/Δt, contact neither way.

        Parameters
        ----------
        radius : float, optional
            Spectral radius: the part of the highest modes that remains after a step, 0 to 1 (no damping).
            Default: 0.8.

        Examples
        --------
        >>> Integrator.GeneralizedAlpha().to_ron()
        'GeneralizedAlpha()'
        """

        radius: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"radius": "num"}
        _variant: ClassVar[str] = "GeneralizedAlpha"

    @dataclass(kw_only=True)
    class Newmark(Builder):
        """The paper's eqs (7)–(13); contact at the positions of the previous step.

        Parameters
        ----------
        alpha : float, optional
            The paper's α (β elsewhere). Default: 0.5.
        delta : float, optional
            The paper's δ (γ elsewhere). Default: 1.0.

        Examples
        --------
        >>> Integrator.Newmark().to_ron()
        'Newmark()'
        """

        alpha: float | None = None
        delta: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"alpha": "num", "delta": "num"}
        _variant: ClassVar[str] = "Newmark"


@dataclass(kw_only=True)
class JointLaw(Builder):
    """Friction on the faces that a named joint made.

    Friction on each side of a contact follows the law of its own face: that of the joint, if it has one here,
    else that of the two materials. Where faces of different joints meet, each law acts on the pressure that
    its side carries, about half.

    Parameters
    ----------
    joint : str
        Name of the joint in `rock`, or of many as in a support; `cells` is that between Voronoi cells.
    friction : Friction, optional
        Friction there. Default: none.
    restitution : float, optional
        Coefficient of restitution there. Default: that of the two materials.
    shear_restitution : float, optional
        Coefficient of restitution along the face there; needs `restitution` beside it. Default: springs are
        damped as contact is along its normal.

    Examples
    --------
    >>> JointLaw(joint="name").to_ron()
    '(joint: "name")'
    """

    joint: str
    friction: Friction | None = None
    restitution: float | None = None
    shear_restitution: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"joint": "str", "friction": "Friction", "restitution": "num", "shear_restitution": "num"}


@dataclass(kw_only=True)
class LinearPressure(Builder):
    """One of several linear pressures.

    Parameters
    ----------
    pressure_pa : float
        Pressure at `at_m` [Pa].
    at_m : Sequence[float], optional
        Where it is that [m]. Default: (0, 0, 0).
    gradient_pa_m : Sequence[float], optional
        Its change per metre along x, y and z [Pa/m]. Default: none.

    Examples
    --------
    >>> LinearPressure(pressure_pa=1.0).to_ron()
    '(pressure_pa: 1.0)'
    """

    pressure_pa: float
    at_m: Sequence[float] | None = None
    gradient_pa_m: Sequence[float] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"pressure_pa": "num", "at_m": "(num)", "gradient_pa_m": "(num)"}


class Mass:
    """How mass is shared among nodes.

    Examples
    --------
    >>> Mass.Consistent
    'Consistent'
    """

    # By the shape functions: the most accurate.
    Consistent: ClassVar[Literal["Consistent"]] = "Consistent"
    # A quarter of an element to each of its nodes, in elastic blocks: waves a little slower, no overshoot
    # beside a loaded node. Their inertia of rotation is too large: 3.5 times the true one in a cube of six
    # tetrahedra, 1.16 times in one of 4³ cells; `ndda check` tells by how much.
    Lumped: ClassVar[Literal["Lumped"]] = "Lumped"


@dataclass(kw_only=True)
class Material(Builder):
    """Linear elastic rock, isotropic or bedded.

    Parameters
    ----------
    name : str
        Name that blocks refer to.
    young_pa : float
        Young's modulus E [Pa].
    poisson : float
        Poisson's ratio ν [-].
    density_kg_m3 : float
        Density ρ [kg/m³].
    bedding : Bedding, optional
        Beds, across which it is another rock than `young_pa` and `poisson` say. Default: none.
    damping : Damping, optional
        Rayleigh damping. Default: none.

    Examples
    --------
    >>> Material(name="name", young_pa=1.0, poisson=1.0, density_kg_m3=1.0).to_ron()
    '(name: "name", young_pa: 1.0, poisson: 1.0, density_kg_m3: 1.0)'
    """

    name: str
    young_pa: float
    poisson: float
    density_kg_m3: float
    bedding: Bedding | None = None
    damping: Damping | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "young_pa": "num", "poisson": "num", "density_kg_m3": "num", "bedding": "Bedding", "damping": "Damping"}


@dataclass(kw_only=True)
class MaterialPair(Builder):
    """Friction between two materials.

    Parameters
    ----------
    between : Sequence[str]
        Names of the two materials, or of one twice.
    friction : Friction, optional
        Friction there. Default: none.
    restitution : float, optional
        Coefficient of restitution there. Default: that of all contacts.
    shear_restitution : float, optional
        Coefficient of restitution along the face there. Default: that of all contacts, or of the normal where
        `restitution` is given here.

    Examples
    --------
    >>> MaterialPair(between=("name", "name")).to_ron()
    '(between: ("name", "name"))'
    """

    between: Sequence[str]
    friction: Friction | None = None
    restitution: float | None = None
    shear_restitution: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"between": "(str)", "friction": "Friction", "restitution": "num", "shear_restitution": "num"}


class Memory:
    """The owner of friction history.

    Examples
    --------
    >>> Memory.Body
    'Body'
    """

    # The facet and the block that it touches.
    Body: ClassVar[Literal["Body"]] = "Body"
    # The facet and the element that it touches, as in the paper: lost on every element border.
    Element: ClassVar[Literal["Element"]] = "Element"


@dataclass(kw_only=True)
class Monitor(Builder):
    """A point whose motion is recorded.

    Parameters
    ----------
    name : str
        Name, unique in the scene.
    block : str
        Name of the block; with `Largest`, of many blocks as in `supports`.
    at : AtChoice, optional
        Where on the block. Default: `Centre`.

    Examples
    --------
    >>> Monitor(name="name", block="name").to_ron()
    '(name: "name", block: "name")'
    """

    name: str
    block: str
    at: AtChoice | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "block": "str", "at": "At"}


@dataclass(kw_only=True)
class MotionRow(Builder):
    """One row of a prescribed motion.

    Parameters
    ----------
    time_s : float
        Time [s].
    displacement_m : Sequence[float]
        Displacement since the start [m]; zero in the first row.

    Examples
    --------
    >>> MotionRow(time_s=1.0, displacement_m=(1.0, 1.0, 1.0)).to_ron()
    '(time_s: 1.0, displacement_m: (1.0, 1.0, 1.0))'
    """

    time_s: float
    displacement_m: Sequence[float]
    _kinds: ClassVar[Mapping[str, str]] = {"time_s": "num", "displacement_m": "(num)"}


class OrientationScatter:
    """How planes of a set scatter about their mean orientation.

    Examples
    --------
    >>> OrientationScatter.None_
    'None'
    """

    # All planes are parallel.
    None_: ClassVar[Literal["None"]] = "None"

    @dataclass(kw_only=True)
    class Normal(Builder):
        """Poles tilt by a normally distributed angle about each of two axes.

        Parameters
        ----------
        deviation_deg : float
            Standard deviation [°].

        Examples
        --------
        >>> OrientationScatter.Normal(deviation_deg=1.0).to_ron()
        'Normal(deviation_deg: 1.0)'
        """

        deviation_deg: float
        _kinds: ClassVar[Mapping[str, str]] = {"deviation_deg": "num"}
        _variant: ClassVar[str] = "Normal"

    @dataclass(kw_only=True)
    class Fisher(Builder):
        """Fisher's distribution.

        Parameters
        ----------
        kappa : float
            Concentration κ; 100 scatters by about 8°.

        Examples
        --------
        >>> OrientationScatter.Fisher(kappa=1.0).to_ron()
        'Fisher(kappa: 1.0)'
        """

        kappa: float
        _kinds: ClassVar[Mapping[str, str]] = {"kappa": "num"}
        _variant: ClassVar[str] = "Fisher"

    @dataclass(kw_only=True)
    class Uniform(Builder):
        """Poles are uniform within an angle of the mean.

        Parameters
        ----------
        within_deg : float
            The angle [°].

        Examples
        --------
        >>> OrientationScatter.Uniform(within_deg=1.0).to_ron()
        'Uniform(within_deg: 1.0)'
        """

        within_deg: float
        _kinds: ClassVar[Mapping[str, str]] = {"within_deg": "num"}
        _variant: ClassVar[str] = "Uniform"


@dataclass(kw_only=True)
class Output(Builder):
    """Files that are written and how often.

    Quantities that are not requested are not computed.

    Parameters
    ----------
    frames : int, optional
        Frames of fields after the first; 0 writes none. Default: 20.
    fields : list[FieldChoice], optional
        Fields of a frame besides positions. Default: `[Displacement, Velocity, VonMises, Stress, BlockId]`.
    format : FieldFormatChoice, optional
        How frames are written. Default: `Compressed`.
    precision : PrecisionChoice, optional
        Numbers of the fields; positions are always `F64`, since coordinates may be large. Default: `F64`.
    history_rows : int, optional
        Rows of `history.csv` after the first, at most one per step. Default: 1000.
    history : TableFormatChoice, optional
        Format of the tables `history`, `contacts` and `blocks`. Default: `Csv`.
    contacts : bool, optional
        Whether what each pair of touching blocks does to each other is written in every row, as
        `contacts.csv`. Default: false.
    blocks : bool, optional
        Whether displacement, rotation, velocity and spin of each block are written at the times of the
        frames, as `blocks.csv`. Default: true.
    reactions : bool, optional
        Whether the forces of supports on held blocks are columns of the history. Default: false.
    checkpoint_wall_s : float, optional
        Wall-clock time between checkpoints [s], which `ndda resume` goes on from; one is written at the start
        and at the end, too. Default: 60.

    Examples
    --------
    >>> Output().to_ron()
    '()'
    """

    frames: int | None = None
    fields: list[FieldChoice] | None = None
    format: FieldFormatChoice | None = None
    precision: PrecisionChoice | None = None
    history_rows: int | None = None
    history: TableFormatChoice | None = None
    contacts: bool | None = None
    blocks: bool | None = None
    reactions: bool | None = None
    checkpoint_wall_s: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"frames": "int", "fields": "[Field]", "format": "FieldFormat", "precision": "Precision", "history_rows": "int", "history": "TableFormat", "contacts": "bool", "blocks": "bool", "reactions": "bool", "checkpoint_wall_s": "num"}


class Pattern:
    """How a box cell is cut into tetrahedra.

    Examples
    --------
    >>> Pattern.Six
    'Six'
    """

    # Six tetrahedra around one diagonal: fewest elements.
    Six: ClassVar[Literal["Six"]] = "Six"
    # Twenty-four around the centre: as symmetric as the cell.
    TwentyFour: ClassVar[Literal["TwentyFour"]] = "TwentyFour"


class Pieces:
    """Pieces that each block of a rock is taken apart into, every one a block of its own.

    What holds them together is the law that `contact.rock_joints` gives the joint `tetrahedra`: bonds, with a
    fracture energy or without. Cracks run between pieces. ```text rock: [(material: "rock", domain:
    Box(min_m: (0, 0, 0), max_m: (1, 1, 2)), into: Tetrahedra(size_m: 0.2, compensate: true))], contact:
    Potential(penalty_pa: 5e11, potential: Smooth(), rock_joints: [ (joint: "tetrahedra", friction:
    (friction_deg: 35, shear_penalty_pa_m: 1e12, cohesion_pa: 10e6, tension_pa: 5e6, fracture: (tension_j_m2:
    50, shear_j_m2: 500))), ]), ```

    Examples
    --------
    >>> Pieces.Tetrahedra(size_m=1.0).to_ron()
    'Tetrahedra(size_m: 1.0)'
    """

    @dataclass(kw_only=True)
    class Tetrahedra(Builder):
        """Tetrahedra.

        The faces between those of one block are the joint `tetrahedra`; faces on other joints keep their
        names.

        Parameters
        ----------
        size_m : float
            Length of their edges, about [m].
        compensate : bool, optional
            Whether they are made stiffer than their material, so that the rock has its Young's modulus with
            the bonds, which make it softer (`ndda check` says by how much). Needs bonds as stiff while they
            are pressed as while they are pulled, `penalty_pa` = ½ `shear_penalty_pa_m` L₀ with the potential
            `Smooth`. Default: false.

        Examples
        --------
        >>> Pieces.Tetrahedra(size_m=1.0).to_ron()
        'Tetrahedra(size_m: 1.0)'
        """

        size_m: float
        compensate: bool | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"size_m": "num", "compensate": "bool"}
        _variant: ClassVar[str] = "Tetrahedra"


class Potential:
    """The potential φ inside a block; the pressure is k_n φ.

    Examples
    --------
    >>> Potential.Element
    'Element'
    """

    # The paper's: 4 min λᵢ in every tetrahedron. Its stiffness depends on the mesh.
    Element: ClassVar[Literal["Element"]] = "Element"

    @dataclass(kw_only=True)
    class Smooth(Builder):
        """Depth below the block's nearest face: stiffness k_n / L₀ per area whatever the mesh.

        Parameters
        ----------
        reference_m : float, optional
            L₀ [m]: the pressure is k_n at this depth. Default: 1.

        Examples
        --------
        >>> Potential.Smooth().to_ron()
        'Smooth()'
        """

        reference_m: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"reference_m": "num"}
        _variant: ClassVar[str] = "Smooth"

    @dataclass(kw_only=True)
    class Closure(Builder):
        """Hyperbolic closure after Bandis, by the same depth: flat joints have σ = k_ni V/(1 − V/V_m), V
        being their closure and k_ni = 2 k_n/L₀; from 0.99 V_m on along the tangent.

        Integrated by quadrature, which takes longer.

        Parameters
        ----------
        max_closure_m : float
            Largest closure V_m [m].
        reference_m : float, optional
            L₀ [m]: k_ni is 2 penalty_pa / L₀. Default: 1.

        Examples
        --------
        >>> Potential.Closure(max_closure_m=1.0).to_ron()
        'Closure(max_closure_m: 1.0)'
        """

        max_closure_m: float
        reference_m: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"reference_m": "num", "max_closure_m": "num"}
        _variant: ClassVar[str] = "Closure"

    @dataclass(kw_only=True)
    class Volume(Builder):
        """One pressure for the whole patch, k_n (V/V₀)^(m − 1), from the volume V that two blocks share.

        Parameters
        ----------
        reference_m3 : float
            V₀ [m³].
        exponent : float, optional
            m, above 1. Default: 2.

        Examples
        --------
        >>> Potential.Volume(reference_m3=1.0).to_ron()
        'Volume(reference_m3: 1.0)'
        """

        reference_m3: float
        exponent: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"exponent": "num", "reference_m3": "num"}
        _variant: ClassVar[str] = "Volume"


class Precision:
    """Numbers of a field.

    Examples
    --------
    >>> Precision.F32
    'F32'
    """

    # Four bytes, seven digits.
    F32: ClassVar[Literal["F32"]] = "F32"
    # Eight bytes, as computed.
    F64: ClassVar[Literal["F64"]] = "F64"


class Pressure:
    """A pressure in space.

    Examples
    --------
    >>> Pressure.Level(at_m=(1.0, 1.0, 1.0)).to_ron()
    'Level(at_m: (1.0, 1.0, 1.0))'
    """

    @dataclass(kw_only=True)
    class Level(Builder):
        """Water at rest below a level, across gravity: ρ g times the depth.

        Parameters
        ----------
        at_m : Sequence[float]
            A point of the level [m].
        density_kg_m3 : float, optional
            Density of the water [kg/m³]. Default: 1000.

        Examples
        --------
        >>> Pressure.Level(at_m=(1.0, 1.0, 1.0)).to_ron()
        'Level(at_m: (1.0, 1.0, 1.0))'
        """

        at_m: Sequence[float]
        density_kg_m3: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"at_m": "(num)", "density_kg_m3": "num"}
        _variant: ClassVar[str] = "Level"

    @dataclass(kw_only=True)
    class Linear(Builder):
        """Linear in space.

        Parameters
        ----------
        pressure_pa : float
            Pressure at `at_m` [Pa].
        at_m : Sequence[float], optional
            Where it is that [m]. Default: (0, 0, 0).
        gradient_pa_m : Sequence[float], optional
            Its change per metre along x, y and z [Pa/m]. Default: none.

        Examples
        --------
        >>> Pressure.Linear(pressure_pa=1.0).to_ron()
        'Linear(pressure_pa: 1.0)'
        """

        pressure_pa: float
        at_m: Sequence[float] | None = None
        gradient_pa_m: Sequence[float] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"pressure_pa": "num", "at_m": "(num)", "gradient_pa_m": "(num)"}
        _variant: ClassVar[str] = "Linear"

    @dataclass(kw_only=True)
    class Points(Builder):
        """A table of points along a direction: linear between them, constant beyond the first and the last.

        Parameters
        ----------
        along : Sequence[float]
            The direction; its length does not matter.
        rows : Sequence[Sequence[float]]
            Distance along the direction [m], ascending, and pressure [Pa].
        at_m : Sequence[float], optional
            Where distances count from [m]. Default: (0, 0, 0).

        Examples
        --------
        >>> Pressure.Points(along=(1.0, 1.0, 1.0), rows=[(1.0, 1.0, 1.0)]).to_ron()
        'Points(along: (1.0, 1.0, 1.0), rows: [(1.0, 1.0, 1.0)])'
        """

        along: Sequence[float]
        rows: Sequence[Sequence[float]]
        at_m: Sequence[float] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"along": "(num)", "at_m": "(num)", "rows": "[(num)]"}
        _variant: ClassVar[str] = "Points"

    @dataclass
    class Least(Builder):
        """The least of several linear pressures: largest in the middle of a joint, none at its edges that
        drain, for instance.

        Parameters
        ----------
        value : list[LinearPressure]
            The least of several linear pressures: largest in the middle of a joint, none at its edges that
            drain, for instance.

        Examples
        --------
        >>> Pressure.Least([LinearPressure(pressure_pa=1.0)]).to_ron()
        'Least([(pressure_pa: 1.0)])'
        """

        value: list[LinearPressure]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "[LinearPressure]"}
        _variant: ClassVar[str] = "Least"


@dataclass(kw_only=True)
class Quiet(Builder):
    """Faces behind which rock goes on for ever: waves leave through them, and may arrive through them (Lysmer
    & Kuhlemeyer 1969).

    They bear −ρ c_p v_n − ρ c_s v_s beside what holds the rock up when time begins: while the scene settles
    they rest on springs of ρ c/2Δt per area, and what these, or an initial stress, bear then stays as a
    constant force. Only elastic blocks have such faces. ```text quiet: [ // Rock goes on below; an S wave
    comes up, from a record on outcropping rock. (block: "ground", on: Set("z_min"), incident: [(wave: S((1,
    0, 0)), motion: Outcrop, record: (file: "quake.at2"))]), // A side beyond which the ground is level, of 6
    m of clay on rock: it moves as that ground does, far away. (block: "*", on: Set("x_min"), layers:
    [(material: "clay", top_m: (0, 0, 20)), (material: "rock", top_m: (0, 0, 14))], incident: [(wave: S((1, 0,
    0)), motion: Outcrop, record: (file: "quake.at2"), from_m: (0, 0, 0))]), ], ```

    Parameters
    ----------
    block : str
        Name of the block; in `base_*` the star stands for anything, and all such blocks with faces in the
        region count.
    on : RegionChoice
        Its faces: boundary triangles of which all corners are in the region.
    beyond : str, optional
        Material of the rock beyond the faces. Default: that of the block.
    layers : list[GroundLayer], optional
        Layers of level ground beyond the faces, whose uppermost border is the ground; the lowest goes on
        below. Waves go straight up and down in them, are reflected at their borders and by the ground, and so
        move the faces as the ground far away moves. Each face is beside the layer that its middle is in. In
        the place of `beyond`, and of `along` and `ground_m` of the waves. Default: none.
    incident : list[IncidentWave], optional
        Plane waves that arrive from beyond. Default: none.

    Examples
    --------
    >>> Quiet(block="name", on=Region.All).to_ron()
    '(block: "name", on: All)'
    """

    block: str
    on: RegionChoice
    beyond: str | None = None
    layers: list[GroundLayer] | None = None
    incident: list[IncidentWave] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "on": "Region", "beyond": "str", "layers": "[GroundLayer]", "incident": "[IncidentWave]"}


class Ramp:
    """How blocks move while forces and loads change in a stage that ends at rest.

    Examples
    --------
    >>> Ramp.Dynamic
    'Dynamic'
    """

    # As they would in this time: a change that is quick makes them oscillate.
    Dynamic: ClassVar[Literal["Dynamic"]] = "Dynamic"
    # Damped, as on the way to rest, so that they hardly oscillate, and the time need not be long. Rows,
    # frames and the label leave these steps out.
    Damped: ClassVar[Literal["Damped"]] = "Damped"


@dataclass(kw_only=True)
class Record(Builder):
    """A record of accelerations and what is done with it, in this order: unit and factor, filter, baseline.

    Acceleration is linear between its rows, and zero before and after; `ndda record` shows it.

    Parameters
    ----------
    file : str
        An `.at2` file of the PEER data base, or a CSV file with a column `time_s`; its path counts from the
        scene file.
    column : str, optional
        Column of accelerations of a CSV file. Default: `acceleration_m_s2`.
    unit : AccelerationUnitChoice, optional
        Unit of the accelerations. Default: that which an `.at2` file names, or in which the name of the
        column ends (`_m_s2`, `_cm_s2`, `_gal`, `_g`), or m/s².
    factor : float, optional
        Factor on the accelerations; a negative one turns them round. Default: 1.
    filter_hz : Sequence[float], optional
        Corner frequencies (low, high) [Hz] of a Butterworth band pass of second order that runs forwards and
        backwards: no shift in time, half of the amplitude at the corners. A low of 0 lets all low frequencies
        pass. Default: no filter.
    baseline : BaselineChoice, optional
        What is taken out of the velocity, so that it does not drift. Default: `None`.
    resample_s : float, optional
        Even spacing to which the record is brought, linearly between its rows [s]. Default: its own rows, or
        their shortest spacing with a filter.

    Examples
    --------
    >>> Record(file="name").to_ron()
    '(file: "name")'
    """

    file: str
    column: str | None = None
    unit: AccelerationUnitChoice | None = None
    factor: float | None = None
    filter_hz: Sequence[float] | None = None
    baseline: BaselineChoice | None = None
    resample_s: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"file": "str", "column": "str", "unit": "AccelerationUnit", "factor": "num", "filter_hz": "(num)", "baseline": "Baseline", "resample_s": "num"}


class RecordedAs:
    """Where the motion of a record was measured, or what was computed from it.

    Examples
    --------
    >>> RecordedAs.Upgoing
    'Upgoing'
    """

    # The wave that arrives.
    Upgoing: ClassVar[Literal["Upgoing"]] = "Upgoing"
    # Rock that crops out, which moves twice as much as the wave that arrives.
    Outcrop: ClassVar[Literal["Outcrop"]] = "Outcrop"
    # Rock at `from_m` below level ground at `ground_m`: the wave that arrives and its echo. The echo is taken
    # out exactly for uniform ground without damping, so that the record must not hold the frequencies at which
    # such a place stands still.
    Within: ClassVar[Literal["Within"]] = "Within"


class Reference:
    """A closed form that the run is compared with.

    Examples
    --------
    >>> Reference.SlidingBlock(monitor="name", downhill=(1.0, 1.0, 1.0), slope_deg=1.0, after_s=1.0).to_ron()
    'SlidingBlock(monitor: "name", downhill: (1.0, 1.0, 1.0), slope_deg: 1.0, after_s: 1.0)'
    """

    @dataclass(kw_only=True)
    class SlidingBlock(Builder):
        """Rigid block on a ramp, the paper's eq (20): S = ½ (sin α − tan φ cos α) g t².

        Parameters
        ----------
        monitor : str
            Monitor on the block.
        downhill : Sequence[float]
            Direction down the slope; its length does not matter.
        slope_deg : float
            Slope angle α [°].
        after_s : float
            `error_max` is taken from here on [s].
        friction_deg : float, optional
            Friction angle φ [°]. Default: 0.
        thickness_m : float, optional
            Thickness of the block normal to the slope [m]; adds the closed form of the shear spring's stick
            stage to the report. Default: none.

        Examples
        --------
        >>> Reference.SlidingBlock(monitor="name", downhill=(1.0, 1.0, 1.0), slope_deg=1.0, after_s=1.0).to_ron()
        'SlidingBlock(monitor: "name", downhill: (1.0, 1.0, 1.0), slope_deg: 1.0, after_s: 1.0)'
        """

        monitor: str
        downhill: Sequence[float]
        slope_deg: float
        after_s: float
        friction_deg: float | None = None
        thickness_m: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"monitor": "str", "downhill": "(num)", "slope_deg": "num", "friction_deg": "num", "thickness_m": "num", "after_s": "num"}
        _variant: ClassVar[str] = "SlidingBlock"

    @dataclass(kw_only=True)
    class Collision(Builder):
        """Two blocks that meet once, centrally and elastically: final velocities from momentum and energy.

        Parameters
        ----------
        first : str
            The block that moves at the start.
        second : str
            The block that it hits.
        along : Sequence[float]
            Line of motion; its length does not matter.
        after_s : float
            `error_max` is taken from here on, after the blocks have parted [s].

        Examples
        --------
        >>> Reference.Collision(first="name", second="name", along=(1.0, 1.0, 1.0), after_s=1.0).to_ron()
        'Collision(first: "name", second: "name", along: (1.0, 1.0, 1.0), after_s: 1.0)'
        """

        first: str
        second: str
        along: Sequence[float]
        after_s: float
        _kinds: ClassVar[Mapping[str, str]] = {"first": "str", "second": "str", "along": "(num)", "after_s": "num"}
        _variant: ClassVar[str] = "Collision"

    @dataclass(kw_only=True)
    class FreeFall(Builder):
        """Free flight of a point under gravity: x = x₀ + v₀ t + ½ g t².

        Parameters
        ----------
        monitor : str
            Monitor on the block.
        after_s : float
            `error_max` is taken from here on [s].

        Examples
        --------
        >>> Reference.FreeFall(monitor="name", after_s=1.0).to_ron()
        'FreeFall(monitor: "name", after_s: 1.0)'
        """

        monitor: str
        after_s: float
        _kinds: ClassVar[Mapping[str, str]] = {"monitor": "str", "after_s": "num"}
        _variant: ClassVar[str] = "FreeFall"

    @dataclass(kw_only=True)
    class FreeSpin(Builder):
        """Torque-free rotation: the angular momentum of the block stays what it was.

        Parameters
        ----------
        block : str
            The block.

        Examples
        --------
        >>> Reference.FreeSpin(block="name").to_ron()
        'FreeSpin(block: "name")'
        """

        block: str
        _kinds: ClassVar[Mapping[str, str]] = {"block": "str"}
        _variant: ClassVar[str] = "FreeSpin"

    @dataclass(kw_only=True)
    class BarImpact(Builder):
        """An elastic bar without lateral strain (ν = 0) that flies along its axis, hits a rigid wall and
        rebounds (Doyen, Ern & Piperno 2011): its mean velocity turns from v₀ to −v₀ in 2 L/c, at a constant
        rate.

        Parameters
        ----------
        block : str
            The bar.
        along : Sequence[float]
            Its axis; its length does not matter.
        length_m : float
            Its length L [m].
        after_s : float
            `error_max` is taken from here on [s].
        gap_m : float, optional
            Its way to the wall [m]. Default: 0.

        Examples
        --------
        >>> Reference.BarImpact(block="name", along=(1.0, 1.0, 1.0), length_m=1.0, after_s=1.0).to_ron()
        'BarImpact(block: "name", along: (1.0, 1.0, 1.0), length_m: 1.0, after_s: 1.0)'
        """

        block: str
        along: Sequence[float]
        length_m: float
        after_s: float
        gap_m: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "along": "(num)", "length_m": "num", "gap_m": "num", "after_s": "num"}
        _variant: ClassVar[str] = "BarImpact"

    @dataclass(kw_only=True)
    class Displacement(Builder):
        """A displacement that is known, that of a structure at rest under its load for instance.

        Parameters
        ----------
        monitor : str
            The monitor.
        displacement_m : Sequence[float]
            Its displacement [m].
        after_s : float
            `error_max` is taken from here on, when all has come to rest [s].

        Examples
        --------
        >>> Reference.Displacement(monitor="name", displacement_m=(1.0, 1.0, 1.0), after_s=1.0).to_ron()
        'Displacement(monitor: "name", displacement_m: (1.0, 1.0, 1.0), after_s: 1.0)'
        """

        monitor: str
        displacement_m: Sequence[float]
        after_s: float
        _kinds: ClassVar[Mapping[str, str]] = {"monitor": "str", "displacement_m": "(num)", "after_s": "num"}
        _variant: ClassVar[str] = "Displacement"


class Region:
    """Part of a block.

    Examples
    --------
    >>> Region.All
    'All'
    """

    # All nodes of the block.
    All: ClassVar[Literal["All"]] = "All"

    @dataclass(kw_only=True)
    class Plane(Builder):
        """The boundary nodes on a plane, to within 1e-6 of the block's size.

        Parameters
        ----------
        point_m : Sequence[float]
            A point on the plane [m].
        normal : Sequence[float]
            Its normal; its length does not matter.

        Examples
        --------
        >>> Region.Plane(point_m=(1.0, 1.0, 1.0), normal=(1.0, 1.0, 1.0)).to_ron()
        'Plane(point_m: (1.0, 1.0, 1.0), normal: (1.0, 1.0, 1.0))'
        """

        point_m: Sequence[float]
        normal: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"point_m": "(num)", "normal": "(num)"}
        _variant: ClassVar[str] = "Plane"

    @dataclass
    class Set(Builder):
        """A named node set of the mesh.

        Parameters
        ----------
        value : str
            A named node set of the mesh.

        Examples
        --------
        >>> Region.Set("name").to_ron()
        'Set("name")'
        """

        value: str
        _kinds: ClassVar[Mapping[str, str]] = {"value": "str"}
        _variant: ClassVar[str] = "Set"


@dataclass(kw_only=True)
class Release(Builder):
    """Where boulders start, and how.

    They are turned at random.

    Parameters
    ----------
    name : str
        Its name.
    place : ReleasePlaceChoice
        Where.
    share : float, optional
        Weight against the other releases [-]. Default: 1.
    height_m : ScatterChoice, optional
        Height of the lowest point of the boulder above the ground at its start [m]. Default: none, it touches
        the ground.
    speed_m_s : ScatterChoice, optional
        Speed at the start [m/s]. Default: none.
    azimuth_deg : ScatterChoice, optional
        Direction of the speed on the map, clockwise from north (y) [°]. Default: down the steepest slope at
        the start.
    dip_deg : ScatterChoice, optional
        Dip of the speed below the horizontal [°]; negative is upward. Default: along the ground for a speed
        without `azimuth_deg`, else 0.
    spin_rad_s : ScatterChoice, optional
        Rate of forward rotation about a horizontal axis across the speed, or across the steepest slope where
        there is none [rad/s]. Default: none.

    Examples
    --------
    >>> Release(name="name", place=ReleasePlace.Points([(1.0, 1.0, 1.0)])).to_ron()
    '(name: "name", place: Points([(1.0, 1.0, 1.0)]))'
    """

    name: str
    place: ReleasePlaceChoice
    share: float | None = None
    height_m: ScatterChoice | None = None
    speed_m_s: ScatterChoice | None = None
    azimuth_deg: ScatterChoice | None = None
    dip_deg: ScatterChoice | None = None
    spin_rad_s: ScatterChoice | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "place": "ReleasePlace", "share": "num", "height_m": "Scatter", "speed_m_s": "Scatter", "azimuth_deg": "Scatter", "dip_deg": "Scatter", "spin_rad_s": "Scatter"}


class ReleasePlace:
    """Where boulders start on the map.

    Examples
    --------
    >>> ReleasePlace.Points([(1.0, 1.0, 1.0)]).to_ron()
    'Points([(1.0, 1.0, 1.0)])'
    """

    @dataclass
    class Points(Builder):
        """At points (x, y) [m], one after the other.

        Parameters
        ----------
        value : Sequence[Sequence[float]]
            At points (x, y) [m], one after the other.

        Examples
        --------
        >>> ReleasePlace.Points([(1.0, 1.0, 1.0)]).to_ron()
        'Points([(1.0, 1.0, 1.0)])'
        """

        value: Sequence[Sequence[float]]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "[(num)]"}
        _variant: ClassVar[str] = "Points"

    @dataclass
    class Line(Builder):
        """Anywhere on a line through these corners (x, y) [m].

        Parameters
        ----------
        value : Sequence[Sequence[float]]
            Anywhere on a line through these corners (x, y) [m].

        Examples
        --------
        >>> ReleasePlace.Line([(1.0, 1.0, 1.0)]).to_ron()
        'Line([(1.0, 1.0, 1.0)])'
        """

        value: Sequence[Sequence[float]]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "[(num)]"}
        _variant: ClassVar[str] = "Line"

    @dataclass
    class Area(Builder):
        """Anywhere in the area within these corners (x, y) [m].

        Parameters
        ----------
        value : Sequence[Sequence[float]]
            Anywhere in the area within these corners (x, y) [m].

        Examples
        --------
        >>> ReleasePlace.Area([(1.0, 1.0, 1.0)]).to_ron()
        'Area([(1.0, 1.0, 1.0)])'
        """

        value: Sequence[Sequence[float]]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "[(num)]"}
        _variant: ClassVar[str] = "Area"


@dataclass(kw_only=True)
class Residual(Builder):
    """Strength of a joint that has slipped.

    Parameters
    ----------
    friction_deg : float
        Residual friction angle φ_r [°].
    cohesion_pa : float, optional
        Residual cohesion c_r [Pa]. Default: 0.
    tension_pa : float, optional
        What is left of the tensile strength where the joint has slipped and not opened [Pa]. With c/tan φ, at
        the peak and here, Mohr and Coulomb's line holds up to its apex, as limit equilibrium assumes.
        Default: 0.
    over_m : float, optional
        Slip over which strength falls linearly [m]. Default: 0, at once.
    opening_m : float, optional
        How far the joint opens at its tensile strength, which it keeps until then with its cohesion, as limit
        equilibrium of perfectly plastic joints assumes [m]. Default: 0, a joint that opens is broken.

    Examples
    --------
    >>> Residual(friction_deg=1.0).to_ron()
    '(friction_deg: 1.0)'
    """

    friction_deg: float
    cohesion_pa: float | None = None
    tension_pa: float | None = None
    over_m: float | None = None
    opening_m: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"friction_deg": "num", "cohesion_pa": "num", "tension_pa": "num", "over_m": "num", "opening_m": "num"}


@dataclass(kw_only=True)
class Rock(Builder):
    """A piece of rock that is cut into blocks.

    They are named `rock_0001`, `rock_0002`, … after its name. Rock is cut with x to the east, y to the north
    and z up. Blocks of a rock come after the explicit ones, in the order of the cut; their node sets have the
    names of the joints and of the faces of the domain that bound them (`cells` between Voronoi cells). A
    column on a base: ```text rock: [ ( name: "column", material: "rock", domain: Box(min_m: (0, 0, 0), max_m:
    (5, 5, 10)), joints: [ Set(name: "bedding", dip_deg: 40, dip_direction_deg: 90, spacing_m: 2), Set(name:
    "cross", dip_deg: 90, dip_direction_deg: 0, spacing_m: 2.5), ], fill: Centre, ), (name: "base", material:
    "rock", domain: Box(min_m: (-3, -3, -10), max_m: (8, 8, 0))), ], supports: [(block: "base_*", on:
    Set("z_min"), hold: Direction((0, 0, 1)))], monitors: [(name: "largest_x", block: "column_*", at:
    Largest((1, 0, 0)))], ```

    Parameters
    ----------
    material : str
        Name of its material.
    domain : DomainChoice
        The rock before it is cut.
    name : str, optional
        Name, unique in the scene, that the names of the blocks begin with. Default: `rock`.
    joints : list[DiscontinuityChoice], optional
        Discontinuities that cut it, in this order: later ones meet smaller blocks. Default: none.
    voronoi : Voronoi, optional
        Cuts it into Voronoi cells instead. Default: none.
    seed : int, optional
        Seed of scatter, persistence and cells: the same seed gives the same blocks. Default: 0.
    sliver_width_m : float, optional
        Blocks thinner than this, or smaller than a cube of this width, are slivers [m]. Default: 0.
    slivers : SliversChoice, optional
        Treatment of slivers. Default: `Merge`.
    fill : FillChoice, optional
        How blocks are filled with tetrahedra. Default: `Fewest`.
    into : PiecesChoice, optional
        Pieces that each block is taken apart into, which bonds hold together. Default: none.
    body : BodyChoice, optional
        How blocks may move. Default: `Elastic`.
    excavations : list[Excavation], optional
        Spaces that stages of construction excavate: their borders cut the rock beforehand, and are glued
        until then. Default: none.
    removed : list[WhereaboutsChoice], optional
        Blocks that are taken out: an excavation. Default: none.
    fixed : list[WhereaboutsChoice], optional
        Blocks that stay where they are, as `body: Fixed`. Default: none.

    Examples
    --------
    >>> Rock(material="name", domain=Domain.Box(min_m=(1.0, 1.0, 1.0), max_m=(1.0, 1.0, 1.0))).to_ron()
    '(material: "name", domain: Box(min_m: (1.0, 1.0, 1.0), max_m: (1.0, 1.0, 1.0)))'
    """

    material: str
    domain: DomainChoice
    name: str | None = None
    joints: list[DiscontinuityChoice] | None = None
    voronoi: Voronoi | None = None
    seed: int | None = None
    sliver_width_m: float | None = None
    slivers: SliversChoice | None = None
    fill: FillChoice | None = None
    into: PiecesChoice | None = None
    body: BodyChoice | None = None
    excavations: list[Excavation] | None = None
    removed: list[WhereaboutsChoice] | None = None
    fixed: list[WhereaboutsChoice] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "material": "str", "domain": "Domain", "joints": "[Discontinuity]", "voronoi": "Voronoi", "seed": "int", "sliver_width_m": "num", "slivers": "Slivers", "fill": "Fill", "into": "Pieces", "body": "Body", "excavations": "[Excavation]", "removed": "[Whereabouts]", "fixed": "[Whereabouts]"}


@dataclass(kw_only=True)
class Rockfall(Builder):
    """Boulders that are released one by one over terrain; `ndda rockfall` runs them.

    Each moves until it rests, leaves the terrain, or `time.end_s` has passed. `time.step_s` is then the
    longest step, 2 ms by default: steps are an eighth of it near the ground, and shorter while a boulder
    touches it.

    Parameters
    ----------
    terrain : GroundChoice
        The ground.
    ground : GroundLaw
        Ground outside of all zones.
    boulders : Boulders
        What falls.
    releases : list[Release]
        Where boulders start; one after the other takes its boulder, as often as its `share` says.
    zones : list[Zone], optional
        Parts of the terrain with ground of their own; where they overlap, the later one counts. Default:
        none.
    class_grid : str, optional
        File of a grid with a class of ground, a whole number, for each cell, in the coordinates of the
        terrain's file: an ESRI ASCII grid (`.asc`) or another of the terrain's formats; path relative to the
        scene file. Zones name their `classes`. Default: none.
    count : int, optional
        How many boulders are released. Default: 100.
    seed : int, optional
        Seed of all that is drawn. A boulder depends on it and on its own number, not on how many there are.
        Default: 1.
    lines : list[CountingLine], optional
        Lines on the map at which boulders are counted and measured, such as a road or a barrier. Default:
        none.
    profile_m : Sequence[Sequence[float]], optional
        Corners of the profile on the map (x, y), along which results are given over the distance from its
        start [m]. Default: from the middle of the releases to the middle of the ends.
    rest : RockfallRest, optional
        When a boulder has come to rest.
    detail : RockfallDetail, optional
        How the ground resists, and what is written.

    Examples
    --------
    >>> Rockfall(terrain=Ground.File(file="name"), ground=GroundLaw(restitution=Scatter.Always(1.0), friction_deg=Scatter.Always(1.0)), boulders=Boulders(material="name", size=BoulderSize.Diameter(diameter_m=Scatter.Always(1.0))), releases=[Release(name="name", place=ReleasePlace.Points([(1.0, 1.0, 1.0)]))]).to_ron()
    '(terrain: File(file: "name"), ground: (restitution: Always(1.0), friction_deg: Always(1.0)), boulders: (material: "name", size: Diameter(diameter_m: Always(1.0))), releases: [(name: "name", place: Points([(1.0, 1.0, 1.0)]))])'
    """

    terrain: GroundChoice
    ground: GroundLaw
    boulders: Boulders
    releases: list[Release]
    zones: list[Zone] | None = None
    class_grid: str | None = None
    count: int | None = None
    seed: int | None = None
    lines: list[CountingLine] | None = None
    profile_m: Sequence[Sequence[float]] | None = None
    rest: RockfallRest | None = None
    detail: RockfallDetail | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"terrain": "Ground", "ground": "GroundLaw", "zones": "[Zone]", "class_grid": "str", "boulders": "Boulders", "releases": "[Release]", "count": "int", "seed": "int", "lines": "[CountingLine]", "profile_m": "[(num)]", "rest": "RockfallRest", "detail": "RockfallDetail"}


@dataclass(kw_only=True)
class RockfallDetail(Builder):
    """How the ground resists, and what is written.

    Parameters
    ----------
    impact_m_s : float, optional
        Speed along the normal of the ground up to which a boulder that hits with a corner goes no deeper than
        5 % of its width [m/s]: the contact is as stiff as that takes. Larger values give shorter steps.
        Default: 15.
    path_m : float, optional
        Distance of the points that are kept of a path [m]. Default: half a step of the terrain, or less where
        it has few.
    cell_m : float, optional
        Side of the cells in which the probability of reach is counted [m]. Default: the step of the terrain.
    part_m : float, optional
        Length of the parts of the profile in which heights, speeds and energies are collected [m]. Default: a
        hundredth of the profile.

    Examples
    --------
    >>> RockfallDetail().to_ron()
    '()'
    """

    impact_m_s: float | None = None
    path_m: float | None = None
    cell_m: float | None = None
    part_m: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"impact_m_s": "num", "path_m": "num", "cell_m": "num", "part_m": "num"}


@dataclass(kw_only=True)
class RockfallRest(Builder):
    """When a boulder that touches the ground has come to rest.

    Parameters
    ----------
    speed_m_s : float, optional
        No point of it is faster than this [m/s] … Default: 0.2.
    over_s : float, optional
        … for this time [s]. Default: 0.5.

    Examples
    --------
    >>> RockfallRest().to_ron()
    '()'
    """

    speed_m_s: float | None = None
    over_s: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"speed_m_s": "num", "over_s": "num"}


@dataclass(kw_only=True)
class Roughness(Builder):
    """Roughness of a joint after Barton and Bandis (1982).

    Parameters
    ----------
    jrc : float
        Joint roughness coefficient JRC [-], from 0 (smooth) to 20.
    jcs_pa : float
        Compressive strength of the walls JCS [Pa].
    sample_m : float, optional
        Length that JRC and JCS were measured on [m]. Default: 0.1.
    length_m : float, optional
        Length of the joint between its crossings with others [m]: JRC and JCS are corrected to it. Default:
        `sample_m`.
    mobilised : bool, optional
        Whether roughness is mobilised and worn off by slip, from no strength at no slip over the peak at
        (L/500) (JRC/L)^0.33 to φ_r at a hundred times that; else the strength is that of the peak at any
        slip. Default: false.
    dilates : bool, optional
        Whether the joint opens by half of its roughness angle while it slips; `ndda joint` tests it in any
        case. Needs `mobilised`, which ends it, the potential `Smooth` or `Closure`, and `memory: Body`.
        Default: false.
    strength_factor : float, optional
        Factor of the shear strength, which `ndda safety` divides. Default: 1.

    Examples
    --------
    >>> Roughness(jrc=1.0, jcs_pa=1.0).to_ron()
    '(jrc: 1.0, jcs_pa: 1.0)'
    """

    jrc: float
    jcs_pa: float
    sample_m: float | None = None
    length_m: float | None = None
    mobilised: bool | None = None
    dilates: bool | None = None
    strength_factor: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"jrc": "num", "jcs_pa": "num", "sample_m": "num", "length_m": "num", "mobilised": "bool", "dilates": "bool", "strength_factor": "num"}


class Scatter:
    """A number that may differ from boulder to boulder, in the unit of its field.

    Examples
    --------
    >>> Scatter.Always(1.0).to_ron()
    'Always(1.0)'
    """

    @dataclass
    class Always(Builder):
        """The same for all.

        Parameters
        ----------
        value : float
            The same for all.

        Examples
        --------
        >>> Scatter.Always(1.0).to_ron()
        'Always(1.0)'
        """

        value: float
        _kinds: ClassVar[Mapping[str, str]] = {"value": "num"}
        _variant: ClassVar[str] = "Always"

    @dataclass
    class Normal(Builder):
        """Mean and standard deviation.

        Parameters
        ----------
        value : Sequence[float]
            Mean and standard deviation.

        Examples
        --------
        >>> Scatter.Normal((1.0, 1.0)).to_ron()
        'Normal(1.0, 1.0)'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "<num>"}
        _variant: ClassVar[str] = "Normal"

    @dataclass
    class LogNormal(Builder):
        """Mean and standard deviation of the number itself, not of its logarithm.

        Parameters
        ----------
        value : Sequence[float]
            Mean and standard deviation of the number itself, not of its logarithm.

        Examples
        --------
        >>> Scatter.LogNormal((1.0, 1.0)).to_ron()
        'LogNormal(1.0, 1.0)'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "<num>"}
        _variant: ClassVar[str] = "LogNormal"

    @dataclass
    class Uniform(Builder):
        """Least and largest value.

        Parameters
        ----------
        value : Sequence[float]
            Least and largest value.

        Examples
        --------
        >>> Scatter.Uniform((1.0, 1.0)).to_ron()
        'Uniform(1.0, 1.0)'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "<num>"}
        _variant: ClassVar[str] = "Uniform"

    @dataclass
    class Triangular(Builder):
        """Least, most likely and largest value.

        Parameters
        ----------
        value : Sequence[float]
            Least, most likely and largest value.

        Examples
        --------
        >>> Scatter.Triangular((1.0, 1.0, 1.0)).to_ron()
        'Triangular(1.0, 1.0, 1.0)'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "<num>"}
        _variant: ClassVar[str] = "Triangular"


@dataclass(kw_only=True)
class Scene(Builder):
    """A complete scene.

    Parameters
    ----------
    title : str
        One line that says what the scene shows.
    time : Time
        Step, end and integrator.
    parameters : Mapping[str, float], optional
        Numbers with a name, from which others are computed: `parameters: (dip_deg: 35)`, and `Calc(90 -
        dip_deg)` where a number stands. Default: none.
    gravity_m_s2 : Sequence[float], optional
        Acceleration of gravity [m/s²]. Default: none.
    gravity_ramp_s : float, optional
        Time over which gravity grows from nothing [s]; 0 applies it suddenly. Default: 0.
    in_situ : InSitu, optional
        Stress in the ground before anything moves, for blocks that have no `initial_stress_pa` and can
        deform. Default: none.
    settle : Settle, optional
        Brings the scene to rest before time begins. Default: it begins as it is written.
    include : Sequence[str], optional
        Files with more materials; their paths count from the scene, and one alone needs no brackets. Default:
        none.
    materials : list[Material], optional
        Materials, referred to by name. Must be written unless there is `include`.
    blocks : list[Block], optional
        Blocks, in the order of the output. Default: none.
    rock : list[Rock], optional
        Rock that is cut into more blocks, which come after `blocks`. Default: none.
    supports : list[Support], optional
        Where blocks are held or moved. Default: nowhere.
    tractions : list[Traction], optional
        Surface tractions. Default: none.
    water : list[Water], optional
        Pressure of water in joints and on faces. Default: none.
    quiet : list[Quiet], optional
        Faces behind which rock goes on, and waves that arrive through them. Default: none.
    ties : list[Tie], optional
        Nodes of equal height that move alike, as at the sides of level ground. Default: none.
    blasts : list[Blast], optional
        Pressure of explosions on the walls of holes. Default: none.
    bolts : list[Bolt], optional
        Rock bolts and anchors. Default: none.
    forces : list[Force], optional
        Forces on points of blocks. Default: none.
    contact : ContactChoice, optional
        Contact between blocks. Must be said when there is more than one block.
    stages : list[Stage], optional
        Stages of construction, one after the other from `time.end_s` on. Default: none.
    rockfall : Rockfall, optional
        Boulders that fall over terrain, one by one, in the place of blocks and rock; `ndda rockfall` runs
        them. Default: none.
    monitors : list[Monitor], optional
        Points whose motion is recorded. Default: none.
    output : Output, optional
        The output: which files, which fields, how often.
    reference : ReferenceChoice, optional
        The closed form that the result is compared with. Default: none.

    Examples
    --------
    >>> Scene(title="name", time=Time(end_s=1.0)).to_ron()
    '(title: "name", time: (end_s: 1.0))'
    """

    title: str
    time: Time
    parameters: Mapping[str, float] | None = None
    gravity_m_s2: Sequence[float] | None = None
    gravity_ramp_s: float | None = None
    in_situ: InSitu | None = None
    settle: Settle | None = None
    include: Sequence[str] | None = None
    materials: list[Material] | None = None
    blocks: list[Block] | None = None
    rock: list[Rock] | None = None
    supports: list[Support] | None = None
    tractions: list[Traction] | None = None
    water: list[Water] | None = None
    quiet: list[Quiet] | None = None
    ties: list[Tie] | None = None
    blasts: list[Blast] | None = None
    bolts: list[Bolt] | None = None
    forces: list[Force] | None = None
    contact: ContactChoice | None = None
    stages: list[Stage] | None = None
    rockfall: Rockfall | None = None
    monitors: list[Monitor] | None = None
    output: Output | None = None
    reference: ReferenceChoice | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"title": "str", "parameters": "{num}", "time": "Time", "gravity_m_s2": "(num)", "gravity_ramp_s": "num", "in_situ": "InSitu", "settle": "Settle", "include": "[str]", "materials": "[Material]", "blocks": "[Block]", "rock": "[Rock]", "supports": "[Support]", "tractions": "[Traction]", "water": "[Water]", "quiet": "[Quiet]", "ties": "[Tie]", "blasts": "[Blast]", "bolts": "[Bolt]", "forces": "[Force]", "contact": "Contact", "stages": "[Stage]", "rockfall": "Rockfall", "monitors": "[Monitor]", "output": "Output", "reference": "Reference"}


@dataclass(kw_only=True)
class Settle(Builder):
    """A phase before time begins: loads, initial stress and contact are brought to equilibrium, then
    displacements are set to zero; initial velocities come after it.

    Parameters
    ----------
    tolerance : float, optional
        Speed left over the largest speed on the way, and with `Adaptive` and `Local` damping unbalanced
        forces over loads, or over the largest unbalanced forces on the way where loads cancel or there are
        none [-]. Default: 1e-4.
    most_steps : int, optional
        Steps after which it is given up. Default: 1000000.
    damping : SettleDampingChoice, optional
        Damping on the way to rest. Default: `Adaptive` where blocks deform; `Kinetic` where none does, where
        friction acts on velocities, and where contact is taken at the end of the step.
    mass_scaling : bool, optional
        Whether blocks have the inertia on the way to rest with which their contacts make all of them
        oscillate as fast as the step allows (weights stay as they are). Rest is reached in fewer steps, and
        as many whatever the step; where friction leaves several equilibria, another one may be found.
        Default: true, but for contact at the end of the step and for `ndda safety`, which take true masses,
        as rigid blocks do in `then: Settle()` of stages.

    Examples
    --------
    >>> Settle().to_ron()
    '()'
    """

    tolerance: float | None = None
    most_steps: int | None = None
    damping: SettleDampingChoice | None = None
    mass_scaling: bool | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"tolerance": "num", "most_steps": "int", "damping": "SettleDamping", "mass_scaling": "bool"}


class SettleDamping:
    """Damping on the way to rest.

    Examples
    --------
    >>> SettleDamping.Kinetic
    'Kinetic'
    """

    # All blocks are stopped whenever the kinetic energy of the scene begins to fall (Cundall 1976; Barnes
    # 1999).
    Kinetic: ClassVar[Literal["Kinetic"]] = "Kinetic"
    # All velocities are damped in proportion, critically for the slowest oscillation that is left (adaptive
    # dynamic relaxation, Underwood 1983).
    Adaptive: ClassVar[Literal["Adaptive"]] = "Adaptive"

    @dataclass(kw_only=True)
    class Local(Builder):
        """Each block loses a part of what a step has changed its velocity by, in proportion to its unbalanced
        force (Cundall 1987).

        Parameters
        ----------
        factor : float, optional
            The part, above 0 and at most 1 [-]. Default: 0.8.

        Examples
        --------
        >>> SettleDamping.Local().to_ron()
        'Local()'
        """

        factor: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"factor": "num"}
        _variant: ClassVar[str] = "Local"


class Shape:
    """Shape and mesh of a block.

    Examples
    --------
    >>> Shape.Box(size_m=(1.0, 1.0, 1.0), cells=(1, 1, 1)).to_ron()
    'Box(size_m: (1.0, 1.0, 1.0), cells: (1, 1, 1))'
    """

    @dataclass(kw_only=True)
    class Box(Builder):
        """A box with one corner at the origin.

        Parameters
        ----------
        size_m : Sequence[float]
            Edge lengths [m].
        cells : Sequence[int]
            Cells along each edge.
        pattern : PatternChoice, optional
            How a cell is cut into tetrahedra. Default: `Six`.

        Examples
        --------
        >>> Shape.Box(size_m=(1.0, 1.0, 1.0), cells=(1, 1, 1)).to_ron()
        'Box(size_m: (1.0, 1.0, 1.0), cells: (1, 1, 1))'
        """

        size_m: Sequence[float]
        cells: Sequence[int]
        pattern: PatternChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"size_m": "(num)", "cells": "(int)", "pattern": "Pattern"}
        _variant: ClassVar[str] = "Box"

    @dataclass(kw_only=True)
    class Prism(Builder):
        """A triangle in the x-y plane extruded along z.

        Parameters
        ----------
        outline_m : Sequence[Sequence[float]]
            Corners of the triangle, counter-clockwise [m].
        height_m : float
            Length of the extrusion [m].
        cells : Sequence[int]
            Cells along each edge of the triangle, and along the height.

        Examples
        --------
        >>> Shape.Prism(outline_m=((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0)), height_m=1.0, cells=(1, 1)).to_ron()
        'Prism(outline_m: ((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0)), height_m: 1.0, cells: (1, 1))'
        """

        outline_m: Sequence[Sequence[float]]
        height_m: float
        cells: Sequence[int]
        _kinds: ClassVar[Mapping[str, str]] = {"outline_m": "((num))", "height_m": "num", "cells": "(int)"}
        _variant: ClassVar[str] = "Prism"

    @dataclass(kw_only=True)
    class Hexahedron(Builder):
        """A box whose eight corners are anywhere: four below, counter-clockwise seen from above, then the
        four above them.

        Parameters
        ----------
        corners_m : Sequence[Sequence[float]]
            The corners [m].
        cells : Sequence[int]
            Cells along x (corner 0 to 1), y (0 to 3) and z (0 to 4).
        pattern : PatternChoice, optional
            How a cell is cut into tetrahedra. Default: `Six`.

        Examples
        --------
        >>> Shape.Hexahedron(corners_m=((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0)), cells=(1, 1, 1)).to_ron()
        'Hexahedron(corners_m: ((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 1.0, 1.0)), cells: (1, 1, 1))'
        """

        corners_m: Sequence[Sequence[float]]
        cells: Sequence[int]
        pattern: PatternChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"corners_m": "((num))", "cells": "(int)", "pattern": "Pattern"}
        _variant: ClassVar[str] = "Hexahedron"

    @dataclass(kw_only=True)
    class Voussoir(Builder):
        """A stone of a circular arch about the y axis.

        Parameters
        ----------
        inner_radius_m : float
            Radius of the lower side [m].
        outer_radius_m : float
            Radius of the upper side [m].
        start_deg : float
            Angle of the first joint from x towards z [°].
        end_deg : float
            Angle of the second joint [°].
        width_m : float
            Extent along y, from 0 [m].
        cells : Sequence[int]
            Cells along the radius, the width and the arc.
        pattern : PatternChoice, optional
            How a cell is cut into tetrahedra. Default: `Six`.

        Examples
        --------
        >>> Shape.Voussoir(inner_radius_m=1.0, outer_radius_m=1.0, start_deg=1.0, end_deg=1.0, width_m=1.0, cells=(1, 1, 1)).to_ron()
        'Voussoir(inner_radius_m: 1.0, outer_radius_m: 1.0, start_deg: 1.0, end_deg: 1.0, width_m: 1.0, cells: (1, 1, 1))'
        """

        inner_radius_m: float
        outer_radius_m: float
        start_deg: float
        end_deg: float
        width_m: float
        cells: Sequence[int]
        pattern: PatternChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"inner_radius_m": "num", "outer_radius_m": "num", "start_deg": "num", "end_deg": "num", "width_m": "num", "cells": "(int)", "pattern": "Pattern"}
        _variant: ClassVar[str] = "Voussoir"

    @dataclass(kw_only=True)
    class Cylinder(Builder):
        """A cylinder about the z axis, from z = 0 up.

        Parameters
        ----------
        radius_m : float
            Radius [m].
        height_m : float
            Height [m].
        cells : Sequence[int]
            Rings around the axis (the outline has 6 corners per ring) and layers.

        Examples
        --------
        >>> Shape.Cylinder(radius_m=1.0, height_m=1.0, cells=(1, 1)).to_ron()
        'Cylinder(radius_m: 1.0, height_m: 1.0, cells: (1, 1))'
        """

        radius_m: float
        height_m: float
        cells: Sequence[int]
        _kinds: ClassVar[Mapping[str, str]] = {"radius_m": "num", "height_m": "num", "cells": "(int)"}
        _variant: ClassVar[str] = "Cylinder"

    @dataclass(kw_only=True)
    class Sphere(Builder):
        """A sphere about the origin, of 8^(levels + 1) tetrahedra.

        In contact with `Smooth` or `Closure`, which take at most 13 faces beside a tetrahedron, `levels` is
        at most 1; with `Element` and `Volume`, there may be more.

        Parameters
        ----------
        radius_m : float
            Radius [m].
        levels : int
            How often an octahedron is refined and rounded.

        Examples
        --------
        >>> Shape.Sphere(radius_m=1.0, levels=1).to_ron()
        'Sphere(radius_m: 1.0, levels: 1)'
        """

        radius_m: float
        levels: int
        _kinds: ClassVar[Mapping[str, str]] = {"radius_m": "num", "levels": "int"}
        _variant: ClassVar[str] = "Sphere"

    @dataclass(kw_only=True)
    class Polyhedron(Builder):
        """A body under flat faces, convex or not.

        Parameters
        ----------
        corners_m : Sequence[Sequence[float]]
            Corners [m].
        faces : Sequence[Sequence[int]]
            Corners of each face, counter-clockwise seen from outside, counted from 0; node sets are `face_0`,
            `face_1`, ….
        fill : FillChoice, optional
            How it is filled. Default: `Fewest`.

        Examples
        --------
        >>> Shape.Polyhedron(corners_m=[(1.0, 1.0, 1.0)], faces=[[1]]).to_ron()
        'Polyhedron(corners_m: [(1.0, 1.0, 1.0)], faces: [[1]])'
        """

        corners_m: Sequence[Sequence[float]]
        faces: Sequence[Sequence[int]]
        fill: FillChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"corners_m": "[(num)]", "faces": "[[int]]", "fill": "Fill"}
        _variant: ClassVar[str] = "Polyhedron"

    @dataclass(kw_only=True)
    class Surface(Builder):
        """A closed surface in a file, filled: STL, OBJ, VTK's `.vtp` or `.vtk`; node sets have the names of
        its parts.

        Parameters
        ----------
        file : str
            Path, relative to the scene file.
        unit_m : float, optional
            Metres per unit of the file. Default: 1.
        fill : FillChoice, optional
            How it is filled. Default: `Fewest`.

        Examples
        --------
        >>> Shape.Surface(file="name").to_ron()
        'Surface(file: "name")'
        """

        file: str
        unit_m: float | None = None
        fill: FillChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"file": "str", "unit_m": "num", "fill": "Fill"}
        _variant: ClassVar[str] = "Surface"

    @dataclass(kw_only=True)
    class Mesh(Builder):
        """A tetrahedral mesh in a file: Gmsh `.msh`, TetGen `.ele`, VTK `.vtu` and `.vtk`, Abaqus `.inp`; or
        a geometry, `.geo` or `.step`, that an installed Gmsh meshes.

        Parameters
        ----------
        file : str
            Path, relative to the scene file.
        body : str, optional
            Body of the file that is this block; may be left out when the file holds one body. Default: none.
        unit_m : float, optional
            Metres per unit of the file. Default: 1.
        size_m : float, optional
            Longest edge that Gmsh makes in a geometry [m]. Default: what the geometry says.
        finer : list[Grading], optional
            Where Gmsh makes a geometry's mesh finer. Default: nowhere.

        Examples
        --------
        >>> Shape.Mesh(file="name").to_ron()
        'Mesh(file: "name")'
        """

        file: str
        body: str | None = None
        unit_m: float | None = None
        size_m: float | None = None
        finer: list[Grading] | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"file": "str", "body": "str", "unit_m": "num", "size_m": "num", "finer": "[Grading]"}
        _variant: ClassVar[str] = "Mesh"


class Slivers:
    """Treatment of slivers.

    Examples
    --------
    >>> Slivers.Merge
    'Merge'
    """

    # Each is united with the neighbour with which it shares the largest face, provided that both together are
    # convex; others stay. No void is left; the joint between the two is closed there. What stays is not united
    # with what is `removed`.
    Merge: ClassVar[Literal["Merge"]] = "Merge"
    # They are taken out, and leave voids, into which blocks may fall.
    Remove: ClassVar[Literal["Remove"]] = "Remove"


class Solver:
    """How a block's equations are solved.

    Examples
    --------
    >>> Solver.Cholesky
    'Cholesky'
    """

    # Factored once (up to 100 unknowns inverted): quickest while the factor fits in memory.
    Cholesky: ClassVar[Literal["Cholesky"]] = "Cholesky"

    @dataclass(kw_only=True)
    class ConjugateGradients(Builder):
        """Iterated anew in every step: little memory, for blocks too large to factor.

        Parameters
        ----------
        tolerance : float, optional
            Residual over right-hand side at which to stop [-]. Default: 1e-12.

        Examples
        --------
        >>> Solver.ConjugateGradients().to_ron()
        'ConjugateGradients()'
        """

        tolerance: float | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"tolerance": "num"}
        _variant: ClassVar[str] = "ConjugateGradients"


class SpacingScatter:
    """How distances of successive planes scatter about the spacing.

    Examples
    --------
    >>> SpacingScatter.None_
    'None'
    """

    # All are equal.
    None_: ClassVar[Literal["None"]] = "None"

    @dataclass(kw_only=True)
    class Uniform(Builder):
        """Uniform about the spacing.

        Parameters
        ----------
        half_width_m : float
            Half of the range, less than the spacing [m].

        Examples
        --------
        >>> SpacingScatter.Uniform(half_width_m=1.0).to_ron()
        'Uniform(half_width_m: 1.0)'
        """

        half_width_m: float
        _kinds: ClassVar[Mapping[str, str]] = {"half_width_m": "num"}
        _variant: ClassVar[str] = "Uniform"

    @dataclass(kw_only=True)
    class Normal(Builder):
        """Normal, at least a tenth of the spacing.

        Parameters
        ----------
        deviation_m : float
            Standard deviation [m].

        Examples
        --------
        >>> SpacingScatter.Normal(deviation_m=1.0).to_ron()
        'Normal(deviation_m: 1.0)'
        """

        deviation_m: float
        _kinds: ClassVar[Mapping[str, str]] = {"deviation_m": "num"}
        _variant: ClassVar[str] = "Normal"

    # Exponential.
    Exponential: ClassVar[Literal["Exponential"]] = "Exponential"


@dataclass(kw_only=True)
class Stage(Builder):
    """A stage of construction: blocks are taken out and added, bolts installed and released, supports, loads
    and laws change, then time goes on or the scene comes to rest.

    Stages follow each other after `time.end_s`. What a stage changes stays changed in those after it; lists
    replace the whole list. ```text stages: [ (name: "heading", remove: ["heading_*"], over_s: 0.05, then:
    Settle()), (name: "bolts", install: ["roof_bolts"], then: Settle()), (name: "lining", add: ["lining_*"],
    then: Settle()), (name: "bench", remove: ["bench_*"], over_s: 0.05, reset_displacements: true, then:
    Run(0.5)), ], ```

    Parameters
    ----------
    name : str
        Its name, that of its checkpoint and of its row in the summary.
    then : ThenChoice
        How the stage goes on.
    remove : Sequence[str], optional
        Blocks that are taken out, by name, or many as in a support. Default: none.
    add : Sequence[str], optional
        Blocks that are put in, without stress and at rest where they were meshed; until then they are not
        there. Default: none.
    install : Sequence[str], optional
        Bolts that are installed in the rock as it lies when the stage begins, by the name of their entry in
        `bolts`, or many as in a support; until then they are not there. Default: none.
    release : Sequence[str], optional
        Bolts that are let go; their forces ramp down over `over_s`. Default: none.
    supports : list[Support], optional
        Supports from now on, in the place of all before. Default: as before.
    tractions : list[Traction], optional
        Tractions from now on, in the place of all before. Default: as before.
    forces : list[Force], optional
        Forces from now on, in the place of all before. Default: as before.
    water : list[Water], optional
        Water from now on, in the place of all before. Default: as before.
    gravity_m_s2 : Sequence[float], optional
        Gravity from now on [m/s²]. Default: as before.
    laws : StageLaws, optional
        Laws of contact from now on. Default: as before.
    over_s : float, optional
        Time over which forces of removed blocks and released bolts fall to nothing, and loads and pretension
        change to the new ones [s]: ten periods of what moves leave it at rest; 0 changes them at once, as a
        blast does. Default: 0.
    reset_displacements : bool, optional
        Whether displacements count from the beginning of this stage. Default: false.

    Examples
    --------
    >>> Stage(name="name", then=Then.Settle()).to_ron()
    '(name: "name", then: Settle())'
    """

    name: str
    then: ThenChoice
    remove: Sequence[str] | None = None
    add: Sequence[str] | None = None
    install: Sequence[str] | None = None
    release: Sequence[str] | None = None
    supports: list[Support] | None = None
    tractions: list[Traction] | None = None
    forces: list[Force] | None = None
    water: list[Water] | None = None
    gravity_m_s2: Sequence[float] | None = None
    laws: StageLaws | None = None
    over_s: float | None = None
    reset_displacements: bool | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "remove": "[str]", "add": "[str]", "install": "[str]", "release": "[str]", "supports": "[Support]", "tractions": "[Traction]", "forces": "[Force]", "water": "[Water]", "gravity_m_s2": "(num)", "laws": "StageLaws", "over_s": "num", "then": "Then", "reset_displacements": "bool"}


@dataclass(kw_only=True)
class StageLaws(Builder):
    """Laws of contact in a stage; a list replaces the whole list.

    Parameters
    ----------
    friction : Friction, optional
        Friction between all blocks. Default: as before.
    material_pairs : list[MaterialPair], optional
        Friction between materials. Default: as before.
    rock_joints : list[JointLaw], optional
        Friction of joints. Default: as before.

    Examples
    --------
    >>> StageLaws().to_ron()
    '()'
    """

    friction: Friction | None = None
    material_pairs: list[MaterialPair] | None = None
    rock_joints: list[JointLaw] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"friction": "Friction", "material_pairs": "[MaterialPair]", "rock_joints": "[JointLaw]"}


class Step:
    """Whether steps may be shorter.

    A step that violates a limit is discarded, contact history included, and repeated again in more parts.

    Examples
    --------
    >>> Step.Fixed
    'Fixed'
    """

    # All are `step_s`.
    Fixed: ClassVar[Literal["Fixed"]] = "Fixed"

    @dataclass(kw_only=True)
    class Auto(Builder):
        """Each is done in as many parts, 1, 2, 4, …, as contact, speed and energy require.

        Parameters
        ----------
        safety : float, optional
            Part of the integrator's bound on ω_c Δt that may be used. Default: 0.5.
        energy : float, optional
            Energy that a step may gain, over the largest energy so far. Default: 1e-4.
        most_halvings : int, optional
            Halvings beyond which a run stops. Default: 12.

        Examples
        --------
        >>> Step.Auto().to_ron()
        'Auto()'
        """

        safety: float | None = None
        energy: float | None = None
        most_halvings: int | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"safety": "num", "energy": "num", "most_halvings": "int"}
        _variant: ClassVar[str] = "Auto"


@dataclass(kw_only=True)
class Stress(Builder):
    """A symmetric stress [Pa], tension positive.

    Parameters
    ----------
    xx : float, optional
        σ_xx [Pa]. Default: 0.
    yy : float, optional
        σ_yy [Pa]. Default: 0.
    zz : float, optional
        σ_zz [Pa]. Default: 0.
    xy : float, optional
        σ_xy [Pa]. Default: 0.
    yz : float, optional
        σ_yz [Pa]. Default: 0.
    zx : float, optional
        σ_zx [Pa]. Default: 0.

    Examples
    --------
    >>> Stress().to_ron()
    '()'
    """

    xx: float | None = None
    yy: float | None = None
    zz: float | None = None
    xy: float | None = None
    yz: float | None = None
    zx: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"xx": "num", "yy": "num", "zz": "num", "xy": "num", "yz": "num", "zx": "num"}


@dataclass(kw_only=True)
class StressGradient(Builder):
    """A change of stress along a direction.

    Parameters
    ----------
    along : Sequence[float]
        The direction; its length does not matter.
    stress_pa_m : Stress
        Change per metre along it [Pa/m].

    Examples
    --------
    >>> StressGradient(along=(1.0, 1.0, 1.0), stress_pa_m=Stress()).to_ron()
    '(along: (1.0, 1.0, 1.0), stress_pa_m: ())'
    """

    along: Sequence[float]
    stress_pa_m: Stress
    _kinds: ClassVar[Mapping[str, str]] = {"along": "(num)", "stress_pa_m": "Stress"}


@dataclass(kw_only=True)
class Support(Builder):
    """A part of a block that is held or moved.

    Parameters
    ----------
    block : str
        Name of the block; in `base_*` the star stands for anything, and all such blocks with a part in the
        region count.
    on : RegionChoice
        Which part of it.
    hold : HoldChoice
        The constraint.
    by : ByChoice, optional
        How it is imposed. Default: `Elimination`.

    Examples
    --------
    >>> Support(block="name", on=Region.All, hold=Hold.Fixed).to_ron()
    '(block: "name", on: All, hold: Fixed)'
    """

    block: str
    on: RegionChoice
    hold: HoldChoice
    by: ByChoice | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "on": "Region", "hold": "Hold", "by": "By"}


class TableFormat:
    """Files of a table.

    Examples
    --------
    >>> TableFormat.Csv
    'Csv'
    """

    # Text that grows while the run goes on.
    Csv: ClassVar[Literal["Csv"]] = "Csv"
    # Parquet, made of the text at the end of the run, which then is removed.
    Parquet: ClassVar[Literal["Parquet"]] = "Parquet"
    # Both.
    Both: ClassVar[Literal["Both"]] = "Both"


class Then:
    """How a stage goes on.

    Examples
    --------
    >>> Then.Settle().to_ron()
    'Settle()'
    """

    @dataclass(kw_only=True)
    class Settle(Builder):
        """To rest: after `over_s`, and one step at least, time stands still until forces balance, with
        damping as in `settle`.

        Parameters
        ----------
        tolerance : float, optional
            Speed left over the largest speed on the way, and with `Adaptive` and `Local` damping unbalanced
            forces over loads, or over the largest unbalanced forces on the way where loads cancel or there
            are none [-]. Default: 1e-4.
        most_steps : int, optional
            Steps after which it is given up. Default: 1000000.
        damping : SettleDampingChoice, optional
            Damping on the way to rest. Default: `Adaptive` where blocks deform; `Kinetic` where none does,
            where friction acts on velocities, and where contact is taken at the end of the step.
        ramp : RampChoice, optional
            How blocks move during `over_s`. Default: `Dynamic`.

        Examples
        --------
        >>> Then.Settle().to_ron()
        'Settle()'
        """

        tolerance: float | None = None
        most_steps: int | None = None
        damping: SettleDampingChoice | None = None
        ramp: RampChoice | None = None
        _kinds: ClassVar[Mapping[str, str]] = {"tolerance": "num", "most_steps": "int", "damping": "SettleDamping", "ramp": "Ramp"}
        _variant: ClassVar[str] = "Settle"

    @dataclass
    class Run(Builder):
        """So many seconds, `over_s` included.

        Parameters
        ----------
        value : float
            So many seconds, `over_s` included.

        Examples
        --------
        >>> Then.Run(1.0).to_ron()
        'Run(1.0)'
        """

        value: float
        _kinds: ClassVar[Mapping[str, str]] = {"value": "num"}
        _variant: ClassVar[str] = "Run"


@dataclass(kw_only=True)
class Tie(Builder):
    """Nodes at equal height that move alike: the sides of level ground, which are those of ground that goes
    on as it is.

    The nodes of all regions at the same place along a direction are one group. Between blocks nothing can be
    tied.

    Parameters
    ----------
    block : str
        Name of the block, which must be elastic; in `base_*` the star stands for anything, and all such
        blocks with nodes in the regions count, each by itself.
    on : list[RegionChoice]
        Regions of which all nodes of one height move alike, such as both sides: `[Set("x_min"),
        Set("x_max")]`.
    along : Sequence[float], optional
        Direction of the height; its length does not matter. Default: against gravity, (0, 0, 1) without.

    Examples
    --------
    >>> Tie(block="name", on=[Region.All]).to_ron()
    '(block: "name", on: [All])'
    """

    block: str
    on: list[RegionChoice]
    along: Sequence[float] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "on": "[Region]", "along": "(num)"}


@dataclass(kw_only=True)
class Time(Builder):
    """Time stepping.

    Parameters
    ----------
    end_s : float
        End of the run, or of what comes before the first of `stages` [s]; rounded to a whole number of steps.
    step_s : float, optional
        Time step Δt [s]. Default: chosen from the stability of contact, speeds and loads, and said with its
        reason.
    integrator : IntegratorChoice, optional
        Time integrator. Default: `Midpoint(theta: 0.5)`.
    step : StepChoice, optional
        Whether steps may be shorter than `step_s`. Default: `Fixed`.
    contact_at : ContactAtChoice, optional
        Where in a step contact is taken. Default: `Predicted`.
    mass : MassChoice, optional
        How mass is shared among the nodes of an element. Default: `Consistent`.
    solver : SolverChoice, optional
        How a block's equations are solved. Default: `Cholesky`.

    Examples
    --------
    >>> Time(end_s=1.0).to_ron()
    '(end_s: 1.0)'
    """

    end_s: float
    step_s: float | None = None
    integrator: IntegratorChoice | None = None
    step: StepChoice | None = None
    contact_at: ContactAtChoice | None = None
    mass: MassChoice | None = None
    solver: SolverChoice | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"step_s": "num", "end_s": "num", "integrator": "Integrator", "step": "Step", "contact_at": "ContactAt", "mass": "Mass", "solver": "Solver"}


class Towards:
    """Places towards which a mesh is finer.

    Examples
    --------
    >>> Towards.Point((1.0, 1.0, 1.0)).to_ron()
    'Point((1.0, 1.0, 1.0))'
    """

    @dataclass
    class Point(Builder):
        """A point [m].

        Parameters
        ----------
        value : Sequence[float]
            A point [m].

        Examples
        --------
        >>> Towards.Point((1.0, 1.0, 1.0)).to_ron()
        'Point((1.0, 1.0, 1.0))'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "(num)"}
        _variant: ClassVar[str] = "Point"

    @dataclass(kw_only=True)
    class Plane(Builder):
        """A plane, that of a face for instance.

        Parameters
        ----------
        point_m : Sequence[float]
            A point of it [m].
        normal : Sequence[float]
            Its normal; its length does not matter.

        Examples
        --------
        >>> Towards.Plane(point_m=(1.0, 1.0, 1.0), normal=(1.0, 1.0, 1.0)).to_ron()
        'Plane(point_m: (1.0, 1.0, 1.0), normal: (1.0, 1.0, 1.0))'
        """

        point_m: Sequence[float]
        normal: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"point_m": "(num)", "normal": "(num)"}
        _variant: ClassVar[str] = "Plane"


@dataclass(kw_only=True)
class Traction(Builder):
    """A traction on part of a block's surface, constant in direction, per area at rest.

    Parameters
    ----------
    block : str
        Name of the block, or of many as in `supports`.
    on : RegionChoice
        Which part of its surface: triangles whose three nodes are all in the region.
    traction_pa : Sequence[float]
        Traction [Pa].
    factor : list[FactorRow], optional
        Factor over time, linear between rows and constant outside. Default: 1.

    Examples
    --------
    >>> Traction(block="name", on=Region.All, traction_pa=(1.0, 1.0, 1.0)).to_ron()
    '(block: "name", on: All, traction_pa: (1.0, 1.0, 1.0))'
    """

    block: str
    on: RegionChoice
    traction_pa: Sequence[float]
    factor: list[FactorRow] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "on": "Region", "traction_pa": "(num)", "factor": "[FactorRow]"}


@dataclass(kw_only=True)
class Turn(Builder):
    """A turn about an axis through the origin of the shape.

    Parameters
    ----------
    axis : Sequence[float]
        Direction of the axis; its length does not matter.
    angle_deg : float
        Angle, right-handed [°].

    Examples
    --------
    >>> Turn(axis=(1.0, 1.0, 1.0), angle_deg=1.0).to_ron()
    '(axis: (1.0, 1.0, 1.0), angle_deg: 1.0)'
    """

    axis: Sequence[float]
    angle_deg: float
    _kinds: ClassVar[Mapping[str, str]] = {"axis": "(num)", "angle_deg": "num"}


@dataclass(kw_only=True)
class Voronoi(Builder):
    """Voronoi cells of random points.

    Parameters
    ----------
    count : int
        Number of points in the rock, and of cells; fewer fit when they keep too large a distance.
    least_distance_m : float, optional
        Distance that points keep where they can [m]. Default: 0.

    Examples
    --------
    >>> Voronoi(count=1).to_ron()
    '(count: 1)'
    """

    count: int
    least_distance_m: float | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"count": "int", "least_distance_m": "num"}


@dataclass(kw_only=True)
class Water(Builder):
    """Pressure of water on faces, along their inward normals as they are at any time, over the whole wet
    area, whether blocks touch there or not.

    Contact then carries the effective stress. Weights stay those of the rock. Where a pressure would be
    negative there is none. The faces of two blocks on one joint are both wet; those on the surface of a joint
    that no other block covers are, too. ```text water: [ // A tension crack filled to z = 10.65 m. (on:
    Joint("crack"), pressure: Level(at_m: (0, 0, 10.65))), // 29.43 kPa at the foot of the crack, nothing at
    the toe. (on: Joint("slide"), pressure: Points(along: (-0.819, 0, -0.574), at_m: (10.9, 0, 7.65), rows:
    [(0, 29430), (13.34, 0)])), ], ```

    Parameters
    ----------
    on : WetChoice
        Which faces are wet.
    pressure : PressureChoice
        The pressure there; that of several entries adds up.
    factor : list[FactorRow], optional
        Factor over time, linear between rows and constant outside. Default: 1.

    Examples
    --------
    >>> Water(on=Wet.Joint("name"), pressure=Pressure.Level(at_m=(1.0, 1.0, 1.0))).to_ron()
    '(on: Joint("name"), pressure: Level(at_m: (1.0, 1.0, 1.0)))'
    """

    on: WetChoice
    pressure: PressureChoice
    factor: list[FactorRow] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"on": "Wet", "pressure": "Pressure", "factor": "[FactorRow]"}


class WaveKind:
    """The kind of a plane wave.

    Examples
    --------
    >>> WaveKind.P
    'P'
    """

    # It moves the rock along its way.
    P: ClassVar[Literal["P"]] = "P"

    @dataclass
    class S(Builder):
        """It moves the rock along this direction, across its way.

        Parameters
        ----------
        value : Sequence[float]
            It moves the rock along this direction, across its way.

        Examples
        --------
        >>> WaveKind.S((1.0, 1.0, 1.0)).to_ron()
        'S((1.0, 1.0, 1.0))'
        """

        value: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"value": "(num)"}
        _variant: ClassVar[str] = "S"


class Wet:
    """Faces that are wet.

    Examples
    --------
    >>> Wet.Joint("name").to_ron()
    'Joint("name")'
    """

    @dataclass
    class Joint(Builder):
        """All faces that joints of this name made, or of many as in a support.

        Parameters
        ----------
        value : str
            All faces that joints of this name made, or of many as in a support.

        Examples
        --------
        >>> Wet.Joint("name").to_ron()
        'Joint("name")'
        """

        value: str
        _kinds: ClassVar[Mapping[str, str]] = {"value": "str"}
        _variant: ClassVar[str] = "Joint"

    @dataclass(kw_only=True)
    class Part(Builder):
        """Part of the surface of a block.

        Parameters
        ----------
        block : str
            Name of the block, or of many as in `supports`.
        region : RegionChoice
            Which part: triangles whose three nodes are all in the region.

        Examples
        --------
        >>> Wet.Part(block="name", region=Region.All).to_ron()
        'Part(block: "name", region: All)'
        """

        block: str
        region: RegionChoice
        _kinds: ClassVar[Mapping[str, str]] = {"block": "str", "region": "Region"}
        _variant: ClassVar[str] = "Part"


class Whereabouts:
    """Which blocks of a rock, by the place of their centroids.

    Examples
    --------
    >>> Whereabouts.Inside(min_m=(1.0, 1.0, 1.0), max_m=(1.0, 1.0, 1.0)).to_ron()
    'Inside(min_m: (1.0, 1.0, 1.0), max_m: (1.0, 1.0, 1.0))'
    """

    @dataclass(kw_only=True)
    class Inside(Builder):
        """Blocks in a box.

        Parameters
        ----------
        min_m : Sequence[float]
            Lowest corner [m].
        max_m : Sequence[float]
            Highest corner [m].

        Examples
        --------
        >>> Whereabouts.Inside(min_m=(1.0, 1.0, 1.0), max_m=(1.0, 1.0, 1.0)).to_ron()
        'Inside(min_m: (1.0, 1.0, 1.0), max_m: (1.0, 1.0, 1.0))'
        """

        min_m: Sequence[float]
        max_m: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"min_m": "(num)", "max_m": "(num)"}
        _variant: ClassVar[str] = "Inside"

    @dataclass(kw_only=True)
    class Beyond(Builder):
        """Blocks on the side of a plane that its normal points to.

        Parameters
        ----------
        point_m : Sequence[float]
            A point of the plane [m].
        normal : Sequence[float]
            Its normal; its length does not matter.

        Examples
        --------
        >>> Whereabouts.Beyond(point_m=(1.0, 1.0, 1.0), normal=(1.0, 1.0, 1.0)).to_ron()
        'Beyond(point_m: (1.0, 1.0, 1.0), normal: (1.0, 1.0, 1.0))'
        """

        point_m: Sequence[float]
        normal: Sequence[float]
        _kinds: ClassVar[Mapping[str, str]] = {"point_m": "(num)", "normal": "(num)"}
        _variant: ClassVar[str] = "Beyond"


@dataclass(kw_only=True)
class Zone(Builder):
    """A part of the terrain with ground of its own, within an outline or of some classes of `class_grid`.

    Parameters
    ----------
    name : str
        Its name.
    restitution : ScatterChoice
        Coefficient of restitution e from 0 to 1.
    friction_deg : ScatterChoice
        Friction angle φ between boulder and ground [°].
    outline_m : Sequence[Sequence[float]], optional
        Corners of its outline on the map (x, y) [m]; a triangle of the terrain is in the zone if its middle
        is. Default: none, it has `classes`.
    classes : Sequence[int], optional
        Classes of `class_grid`; a triangle of the terrain is in the zone if its middle is in a cell of one of
        them. Default: none, it has an outline.

    Examples
    --------
    >>> Zone(name="name", restitution=Scatter.Always(1.0), friction_deg=Scatter.Always(1.0)).to_ron()
    '(name: "name", restitution: Always(1.0), friction_deg: Always(1.0))'
    """

    name: str
    restitution: ScatterChoice
    friction_deg: ScatterChoice
    outline_m: Sequence[Sequence[float]] | None = None
    classes: Sequence[int] | None = None
    _kinds: ClassVar[Mapping[str, str]] = {"name": "str", "outline_m": "[(num)]", "classes": "[int]", "restitution": "Scatter", "friction_deg": "Scatter"}


AccelerationUnitChoice: TypeAlias = Literal["G"] | Literal["MetrePerSecondSquared"] | Literal["CentimetrePerSecondSquared"]
AtChoice: TypeAlias = Literal["Centre"] | At.Point | At.Largest
AxisChoice: TypeAlias = Literal["X"] | Literal["Y"] | Literal["Z"]
BaselineChoice: TypeAlias = Literal["None"] | Literal["Linear"] | Literal["Quadratic"]
BlastPressureChoice: TypeAlias = BlastPressure.Rows | BlastPressure.Duvall
BlastWallChoice: TypeAlias = BlastWall.Part | BlastWall.Hole
BodyChoice: TypeAlias = Literal["Elastic"] | Literal["Affine"] | Literal["Rigid"] | Literal["Fixed"]
BoltPlaceChoice: TypeAlias = BoltPlace.Line | BoltPlace.Rows
BoulderShapeChoice: TypeAlias = BoulderShape.Cuboid | BoulderShape.Ellipsoid | BoulderShape.Polyhedron
BoulderSizeChoice: TypeAlias = BoulderSize.Diameter | BoulderSize.Volume | BoulderSize.Mass
ByChoice: TypeAlias = Literal["Elimination"] | By.Springs
ContactChoice: TypeAlias = Literal["Off"] | Contact.Potential
ContactAtChoice: TypeAlias = Literal["Predicted"] | ContactAt.End
DiscRuleChoice: TypeAlias = DiscRule.Share | Literal["Meets"] | Literal["Covers"]
DiscontinuityChoice: TypeAlias = Discontinuity.Set | Discontinuity.Plane | Discontinuity.Disc | Discontinuity.Discs
DomainChoice: TypeAlias = Domain.Box | Domain.Column | Domain.Polyhedron | Domain.File | Domain.Terrain | Domain.TerrainFile
FieldChoice: TypeAlias = Literal["Displacement"] | Literal["Velocity"] | Literal["Acceleration"] | Literal["Stress"] | Literal["VonMises"] | Literal["ContactForce"] | Literal["ContactTraction"] | Literal["FrictionState"] | Literal["BlockId"] | Literal["Material"]
FieldFormatChoice: TypeAlias = Literal["Compressed"] | Literal["Appended"] | Literal["Base64"]
FillChoice: TypeAlias = Literal["Fewest"] | Literal["Centre"] | Fill.Size | Fill.TetGen
GroundChoice: TypeAlias = Ground.File | Ground.Heights
HoldChoice: TypeAlias = Literal["Fixed"] | Literal["Normal"] | Hold.Direction | Hold.Motion | Hold.Acceleration | Hold.Shaking
IntegratorChoice: TypeAlias = Integrator.Midpoint | Integrator.GeneralizedAlpha | Integrator.Newmark
MassChoice: TypeAlias = Literal["Consistent"] | Literal["Lumped"]
MemoryChoice: TypeAlias = Literal["Body"] | Literal["Element"]
OrientationScatterChoice: TypeAlias = Literal["None"] | OrientationScatter.Normal | OrientationScatter.Fisher | OrientationScatter.Uniform
PatternChoice: TypeAlias = Literal["Six"] | Literal["TwentyFour"]
PiecesChoice: TypeAlias = Pieces.Tetrahedra
PotentialChoice: TypeAlias = Literal["Element"] | Potential.Smooth | Potential.Closure | Potential.Volume
PrecisionChoice: TypeAlias = Literal["F32"] | Literal["F64"]
PressureChoice: TypeAlias = Pressure.Level | Pressure.Linear | Pressure.Points | Pressure.Least
RampChoice: TypeAlias = Literal["Dynamic"] | Literal["Damped"]
RecordedAsChoice: TypeAlias = Literal["Upgoing"] | Literal["Outcrop"] | Literal["Within"]
ReferenceChoice: TypeAlias = Reference.SlidingBlock | Reference.Collision | Reference.FreeFall | Reference.FreeSpin | Reference.BarImpact | Reference.Displacement
RegionChoice: TypeAlias = Literal["All"] | Region.Plane | Region.Set
ReleasePlaceChoice: TypeAlias = ReleasePlace.Points | ReleasePlace.Line | ReleasePlace.Area
ScatterChoice: TypeAlias = Scatter.Always | Scatter.Normal | Scatter.LogNormal | Scatter.Uniform | Scatter.Triangular
SettleDampingChoice: TypeAlias = Literal["Kinetic"] | Literal["Adaptive"] | SettleDamping.Local
ShapeChoice: TypeAlias = Shape.Box | Shape.Prism | Shape.Hexahedron | Shape.Voussoir | Shape.Cylinder | Shape.Sphere | Shape.Polyhedron | Shape.Surface | Shape.Mesh
SliversChoice: TypeAlias = Literal["Merge"] | Literal["Remove"]
SolverChoice: TypeAlias = Literal["Cholesky"] | Solver.ConjugateGradients
SpacingScatterChoice: TypeAlias = Literal["None"] | SpacingScatter.Uniform | SpacingScatter.Normal | Literal["Exponential"]
StepChoice: TypeAlias = Literal["Fixed"] | Step.Auto
TableFormatChoice: TypeAlias = Literal["Csv"] | Literal["Parquet"] | Literal["Both"]
ThenChoice: TypeAlias = Then.Settle | Then.Run
TowardsChoice: TypeAlias = Towards.Point | Towards.Plane
WaveKindChoice: TypeAlias = Literal["P"] | WaveKind.S
WetChoice: TypeAlias = Wet.Joint | Wet.Part
WhereaboutsChoice: TypeAlias = Whereabouts.Inside | Whereabouts.Beyond


__all__ = [
    "AccelerationUnit",
    "At",
    "Axis",
    "Baseline",
    "Bedding",
    "Blast",
    "BlastPressure",
    "BlastWall",
    "Block",
    "Body",
    "Bolt",
    "BoltDowel",
    "BoltGrout",
    "BoltPlace",
    "BoltPlate",
    "BoltSteel",
    "BoulderShape",
    "BoulderSize",
    "Boulders",
    "By",
    "Component",
    "Contact",
    "ContactAt",
    "CountingLine",
    "Damping",
    "Dilation",
    "DiscRule",
    "Discontinuity",
    "Domain",
    "Excavation",
    "FactorRow",
    "Field",
    "FieldFormat",
    "Fill",
    "Force",
    "FractureEnergy",
    "Friction",
    "Grading",
    "Ground",
    "GroundLaw",
    "GroundLayer",
    "Hold",
    "InSitu",
    "IncidentWave",
    "Integrator",
    "JointLaw",
    "LinearPressure",
    "Mass",
    "Material",
    "MaterialPair",
    "Memory",
    "Monitor",
    "MotionRow",
    "OrientationScatter",
    "Output",
    "Pattern",
    "Pieces",
    "Potential",
    "Precision",
    "Pressure",
    "Quiet",
    "Ramp",
    "Record",
    "RecordedAs",
    "Reference",
    "Region",
    "Release",
    "ReleasePlace",
    "Residual",
    "Rock",
    "Rockfall",
    "RockfallDetail",
    "RockfallRest",
    "Roughness",
    "Scatter",
    "Scene",
    "Settle",
    "SettleDamping",
    "Shape",
    "Slivers",
    "Solver",
    "SpacingScatter",
    "Stage",
    "StageLaws",
    "Step",
    "Stress",
    "StressGradient",
    "Support",
    "TableFormat",
    "Then",
    "Tie",
    "Time",
    "Towards",
    "Traction",
    "Turn",
    "Voronoi",
    "Water",
    "WaveKind",
    "Wet",
    "Whereabouts",
    "Zone",
]
