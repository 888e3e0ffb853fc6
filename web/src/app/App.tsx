import { lazy, Suspense, useEffect, type ComponentType, type ReactNode } from "react";
import { useLocation } from "wouter";
import { OPENED } from "../hub/openedTheatre";
import { SignInPage } from "../signin/SignInPage";
import { LiveProvider } from "../live/LiveContext";
import { LookReport } from "../room/LookReport";
import { RoomProvider } from "../room/RoomContext";
import { TourProvider } from "../tour/TourContext";
import { TheatreView } from "../theatre/TheatreView";
import { ProcedureProvider } from "./procedure";
import { useSession } from "./session";
import { CAMERA_PATH, isCameraAt, viewAt, type ViewName } from "./views";

// A screen in theatre does not load the pages of the tablet.
const VIEWS: Record<ViewName, ComponentType> = {
  theatre: TheatreView,
  operator: lazy(async () => ({ default: (await import("../operator/OperatorView")).OperatorView })),
  supervisor: lazy(async () => ({ default: (await import("../supervisor/SupervisorView")).SupervisorView })),
};

const TheatreList = lazy(async () => ({ default: (await import("../hub/TheatreList")).TheatreList }));
const OpenedTheatre = lazy(async () => ({ default: (await import("../hub/OpenedTheatre")).OpenedTheatre }));
const CameraPage = lazy(async () => ({ default: (await import("../phone/CameraPage")).CameraPage }));
// Only the document at the camera's address has permission to use a camera.
const LOADED_AT = location.pathname;

/** Shows a view to users who are signed in, and the sign-in page to others. */
export function App(): ReactNode {
  const { session } = useSession();
  const [path] = useLocation();
  if (session.state !== "in" || path === "/enter") return <SignInPage />;
  if (session.isHub) {
    return (
      <Suspense fallback={null}>
        {OPENED === null ? <TheatreList /> : <OpenedTheatre name={OPENED} />}
      </Suspense>
    );
  }
  if (isCameraAt(path, session.who.role)) {
    return <Suspense fallback={null}>{LOADED_AT === CAMERA_PATH ? <CameraPage /> : <LoadedAnew />}</Suspense>;
  }
  const view = viewAt(path, session.who.role);
  const View = VIEWS[view];
  return (
    <LiveProvider>
      <RoomProvider view={view}>
        <LookReport />
        <ProcedureProvider view={view}>
          <TourProvider>
            <Suspense fallback={null}>
              <View />
            </Suspense>
          </TourProvider>
        </ProcedureProvider>
      </RoomProvider>
    </LiveProvider>
  );
}

function LoadedAnew(): ReactNode {
  useEffect(() => {
    location.replace(CAMERA_PATH + location.search);
  }, []);
  return null;
}
