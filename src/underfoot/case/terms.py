"""Words of the field, each in a sentence."""

TERMS = {
    "cof": "coefficient of friction: friction force over normal force.",
    "acof": "available coefficient of friction: what shoe, floor and contaminant offer.",
    "rcof": "required coefficient of friction: what a step needs not to slip, from force plates "
    "on a dry floor (peak ratio of shear to vertical force early in stance).",
    "adhesion": "friction from breaking the bonds where the surfaces really touch; a contaminant "
    "blocks part of it (Eq. 26).",
    "hysteresis": "friction from the losses in rubber that floor asperities deform while sliding.",
    "boundary lubrication": "touching asperities carry the load and make the friction; the film "
    "carries less than a tenth of it.",
    "mixed lubrication": "load shared between touching asperities and fluid pressure.",
    "full film": "the fluid carries all of the load; friction is only its shear.",
    "regime": "who carries the load. By lambda: a smooth film over undeformed roughness, boundary "
    "below 1, full film above 3. By load share: what the fluid carries, boundary below 10 %, full "
    "film above 90 %. They can differ: soft asperities flatten and are held apart by a mean "
    "pressure far below their stiffness (load share ahead of lambda), and waves longer than the "
    "stylus' cut-off keep carrying where lambda counts a thick film (lambda ahead).",
    "lambda": "film thickness over the roughness of both surfaces together (Eq. 21); see regime.",
    "load share": "part of the load that the fluid carries; see regime.",
    "stribeck": "the fall of friction with speed and viscosity as the film takes over the load; "
    "here COF = asymptote + (COF_BL - asymptote) exp(-v / tau_hydro) (Eq. 17).",
    "wedge": "fluid drawn into a narrowing gap builds up pressure that lifts the sole.",
    "squeeze film": "fluid that must leave from under a sole coming down, and resists.",
    "effective_rq": "roughness of the interface that sets how well fluid leaks out and asperities "
    "touch. The least known input: a stylus with a short cut-off gives too small a value.",
    "rq": "root-mean-square deviation of a profile from its mean line; name the cut-off with it.",
    "ra": "mean absolute deviation of a profile from its mean line; name the cut-off with it.",
    "rz": "mean over sampling lengths of the highest peak to the deepest valley.",
    "shore a": "hardness of rubber by the depth a blunt cone goes in, 0 (soft) to 100.",
    "fluid_load": "part of the normal force that fluid pressure carries under the whole sole.",
    "fluid_load_sensor": "what a row of pressure sensors in the floor would read of the fluid "
    "load: a wide inlet averages over tread channels and reads too little (Eq. 27).",
    "fluid_share": "at each point, the part of the pressure that the fluid carries; 100 % is a "
    "full film.",
    "clearance": "height of the undeformed sole above the floor as it stands there.",
    "land": "where a sole can touch the floor: lugs and untreaded parts, not channels.",
    "pool_depth": "depth of the liquid on the floor; deeper gaps hold no film.",
    "facet": "plane bevel at the rear of the heel, moulded or worn.",
    "assumed": "no measurement and no publication stands behind this value: measure it.",
}
