import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import type { ConnectionState } from "./messages";
import { useRoomSnapshot } from "./RoomContext";

const SYMBOL: Record<ConnectionState, string> = { good: "●", slow: "◐", silent: "▲" };

/** The viewers: number, names, roles and connection quality. */
export function Viewers(): ReactNode {
  const { room: texts, rest } = useTexts();
  const { isConnected, firstMessage, people } = useRoomSnapshot();
  if (!isConnected) {
    return (
      <p className="watching" data-testid="watching" data-known="false">
        {firstMessage === "awaited" ? rest.loading : texts.unknown}
      </p>
    );
  }
  return (
    <div className="watching" data-testid="watching" data-known="true">
      <p className="watching-count">
        {texts.watching} <strong>{people.length}</strong>
      </p>
      <ul>
        {people.map((one) => (
          <li key={`${one.name} ${one.role} ${one.since}`} data-line={one.line}>
            <span aria-hidden="true" className="watching-line">
              {SYMBOL[one.line]}
            </span>{" "}
            <b>{one.name}</b> <span className="watching-role">{texts.role[one.role]}</span>
            {one.is_you && <span className="watching-role"> · {texts.you}</span>}
            {one.line !== "good" && <em> · {texts.line[one.line]}</em>}
          </li>
        ))}
      </ul>
    </div>
  );
}
