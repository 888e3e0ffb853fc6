import { lazy, Suspense, type ComponentType, type ReactNode } from "react";
import { useLocation } from "wouter";
import { EnterPage } from "../enter/EnterPage";
import { LiveProvider } from "../live/LiveContext";
import { RoomProvider } from "../room/RoomContext";
import { TheatreView } from "../theatre/TheatreView";
import { ProcedureProvider } from "./procedure";
import { useSession } from "./session";
import { viewAt, type ViewName } from "./views";

// A screen in theatre loads nothing of the pages that only a tablet shows.
const VIEWS: Record<ViewName, ComponentType> = {
  theatre: TheatreView,
  operator: lazy(async () => ({ default: (await import("../operator/OperatorView")).OperatorView })),
  supervisor: lazy(async () => ({ default: (await import("../supervisor/SupervisorView")).SupervisorView })),
};

/** Who is signed in sees a view; everybody else the door. */
export function App(): ReactNode {
  const { session } = useSession();
  const [path] = useLocation();
  if (session.state !== "in" || path === "/enter") return <EnterPage />;
  const view = viewAt(path, session.who.role);
  const View = VIEWS[view];
  return (
    <LiveProvider>
      <RoomProvider view={view}>
        <ProcedureProvider view={view}>
          <Suspense fallback={null}>
            <View />
          </Suspense>
        </ProcedureProvider>
      </RoomProvider>
    </LiveProvider>
  );
}
