// How the procedure stands: asked for once, for the whole page.
export { useProcedure, type Procedure, type Step } from "../app/procedure";
