"""The best designs of a study as files for others: case files, soles as STEP, one table."""

from __future__ import annotations

import shutil
from pathlib import Path

from underfoot.compute.sole import new_sole
from underfoot.core import InputError, MissingExtraError
from underfoot.core.files import whole_folder

from .study import Study


def export_designs(
    study: Study, folder: Path, *, count: int = 3, step: bool = True, overwrite: bool = False
) -> list[str]:
    """Write results.csv, and a case file and a STEP file of the best designs; return remarks.

    The case of a design is that of its first condition and draw. A sole from a file, or one that
    can't be made as a solid, has no STEP file; a remark says so. Walls in it are upright; of a free
    tread with ``mould_draft`` there is a mesh (STL) with that draft beside it.
    """
    result, plan = study.result(), study.plan
    study.store.write_views(result.cases())
    remarks: list[str] = []
    with whole_folder(folder, overwrite=overwrite) as staging:
        for name in ("results.csv", "results.parquet"):
            if (study.store.folder / name).exists():
                shutil.copyfile(study.store.folder / name, staging / name)
        for design in result.best(count) if plan.goals else result.designs[:count]:
            name = f"design_{design.number}"
            job = next(job for job in result.jobs if job.design == design.number)
            case = plan.base.replace(
                {**job.changes, "name": f"{plan.name}, design {design.number}"}
            )
            case.save(staging / f"{name}.toml")
            if step:
                try:
                    from underfoot.shoe.parametric import sole_solid, write_sole

                    shape, draft = new_sole(case), getattr(case.shoe.tread, "mould_draft", 0.0)
                    solid = sole_solid(shape)
                    write_sole(shape, staging / f"{name}.step", solid=solid)
                    if draft:
                        from underfoot.shoe.parametric.mould import write_drafted

                        write_drafted(shape, solid, draft, staging / f"{name}.stl")
                except (InputError, MissingExtraError) as error:
                    remarks.append(f"{name}.step was not written: {error}")
    return remarks
