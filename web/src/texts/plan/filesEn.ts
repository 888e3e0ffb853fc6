// The surface and the plan as files.
export const filesEn = {
  surface: {
    title: "Surface of the bone",
    hint: "Its outline on the slices should follow the edge of the bone. It is shown in 3-D during navigation, and a sweep of the tip over it makes a registration finer.",
    none: "There is no surface yet.",
    make: "Make it out of the CT",
    makeAnew: "Make it anew out of the CT",
    outOfDate: "This surface is out of date",
    source: "Made from",
    fromCt: "the CT of this case",
    fromFile: "a file",
    faces: "Triangles",
    size: "Size",
    threshold: "Bone from",
    unit: "Unit of the file's numbers",
    unitUnsaid: "Not said: it has to be mm",
    units: {
      mm: "millimetres",
      cm: "centimetres",
      m: "metres",
      inch: "inches",
      um: "micrometres",
    },
    proposedUnit: "Its size would fit in the unit",
    sayUnit: "Measure the bone, choose its unit below, and send the file again. Nothing is scaled unasked.",
    send: "Send STL, OBJ or PLY …",
    max: "at most",
  },
  file: {
    title: "Plan as a file",
    hint: "The file says who made the plan, when, and on which CT. Nothing in it names the patient.",
    none: "There is no plan yet that could be written out.",
    out: "Write the plan to a file",
    outForSlicer: "Write it for 3D Slicer",
    in: "Take a plan in …",
    replaces: "A plan that is taken in replaces the one that is shown; Undo brings it back.",
    otherCt: "This plan was made on another CT",
    otherCtHint:
      "Its channels may lie anywhere on this one. Take it only if both are of this patient in one position, and check every channel.",
    takeAllTheSame: "Take it all the same",
  },
};

export type FilesTexts = typeof filesEn;
