# FreeCAD runs this file when its window starts.
import FreeCADGui


class OctafrontWorkbench(FreeCADGui.Workbench):
    """Meshes of tetrahedra by the program octafront, for FreeCAD's FEM workbench."""

    def __init__(self):
        from octafront_fem.gui import view
        self.__class__.Icon = view.ICON
        self.__class__.MenuText = "Octafront"
        self.__class__.ToolTip = "Meshes of tetrahedra for the FEM workbench, by the program octafront"

    def Initialize(self):
        import Fem  # noqa: F401  registers the types of objects
        import FemGui  # noqa: F401
        import femcommands.commands  # noqa: F401  commands of the FEM workbench that stand beside ours
        from octafront_fem.gui import commands
        own = commands.register()
        others = ["FEM_Analysis", "FEM_SolverCalculixCxxtools", "FEM_MaterialSolid", "FEM_ConstraintFixed", "FEM_ConstraintForce",
                  "FEM_ConstraintPressure", "FEM_SolverRun"]
        self.appendToolbar("Octafront", own)
        self.appendToolbar("FEM job", others)
        self.appendMenu("&Octafront", own + ["Separator"] + others)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


FreeCADGui.addWorkbench(OctafrontWorkbench())
