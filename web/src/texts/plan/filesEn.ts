// Surface and plan files.
export const filesEn = {
  surface: {
    title: "Bone surface",
    hint: "Its outline on the slices should follow the edge of the bone. It is shown in 3-D during navigation, and is used for a surface sweep.",
    none: "There is no surface yet.",
    make: "Create from the CT",
    makeAnew: "Create from the CT again",
    outOfDate: "This surface is out of date",
    source: "Created from",
    fromCt: "the CT of this case",
    fromFile: "a file",
    faces: "Triangles",
    size: "Size",
    threshold: "Bone from",
    unit: "Unit of the file's numbers",
    unitUnsaid: "Not specified: millimetres",
    units: {
      mm: "millimetres",
      cm: "centimetres",
      m: "metres",
      inch: "inches",
      um: "micrometres",
    },
    proposedUnit: "Unit that fits this size",
    sayUnit:
      "Measure the bone, choose the unit below, and send the file again. The file is not scaled automatically.",
    send: "Send STL, OBJ or PLY …",
    max: "at most",
  },
  file: {
    title: "Plan as a file",
    hint: "The file contains who made the plan, when, and on which CT, but no patient data.",
    none: "There is no plan yet.",
    out: "Save the plan as a file",
    outForSlicer: "Save for 3D Slicer",
    in: "Import a plan …",
    replaces: "An imported plan replaces the one shown; Undo restores it.",
    otherCt: "This plan was made on another CT",
    otherCtHint:
      "Its channels may be wrong on this CT. Import it only if both CTs show the same patient in the same position, and check every channel.",
    takeAllTheSame: "Import anyway",
  },
};

export type FilesTexts = typeof filesEn;
