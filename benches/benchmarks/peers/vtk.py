"""VTK's filters."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkDecimatePro, vtkQuadricDecimation

from . import Positions, Triangles

DISTRIBUTION = "vtk"


@dataclass(frozen=True)
class Filter:
    make: Callable[[], Any]

    def load(self, positions: Positions, triangles: Triangles) -> vtkPolyData:
        points = vtkPoints()
        points.SetData(numpy_to_vtk(positions, deep=True))
        cells = vtkCellArray()
        offsets = np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int64)
        corners = triangles.astype(np.int64).ravel()
        cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(corners, deep=True))
        mesh = vtkPolyData()
        mesh.SetPoints(points)
        mesh.SetPolys(cells)
        return mesh

    def simplify(self, held: vtkPolyData, count: int) -> vtkPolyData:
        decimation = self.make()
        decimation.SetTargetReduction(1.0 - count / held.GetNumberOfPolys())
        decimation.SetInputData(held)
        decimation.Update()
        return decimation.GetOutput()

    def unload(self, held: vtkPolyData) -> tuple[np.ndarray, np.ndarray]:
        corners = vtk_to_numpy(held.GetPolys().GetConnectivityArray())
        return vtk_to_numpy(held.GetPoints().GetData()).copy(), corners.reshape(-1, 3).copy()


SIMPLIFIERS = {"VTK quadric": Filter(vtkQuadricDecimation), "VTK DecimatePro": Filter(vtkDecimatePro)}
