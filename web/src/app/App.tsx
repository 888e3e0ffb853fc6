import type { ReactNode } from "react";
import { useLocation } from "wouter";
import { EnterPage } from "../enter/EnterPage";
import { LiveProvider } from "../live/LiveContext";
import { OperatorView } from "../operator/OperatorView";
import { RoomProvider } from "../room/RoomContext";
import { SupervisorView } from "../supervisor/SupervisorView";
import { TheatreView } from "../theatre/TheatreView";
import { useSession } from "./session";
import { viewAt, type ViewName } from "./views";

const VIEWS: Record<ViewName, () => ReactNode> = {
  theatre: TheatreView,
  operator: OperatorView,
  supervisor: SupervisorView,
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
        <View />
      </RoomProvider>
    </LiveProvider>
  );
}
