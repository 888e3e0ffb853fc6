import { Button, Select, TextInput } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { Link } from "wouter";
import { getMarkers } from "../../api";
import { QueryStatus } from "../../rest/QueryStatus";
import { useQuery } from "../../rest/useQuery";
import { useTexts } from "../../texts/TextsContext";
import { StepActions } from "../StepActions";
import { Card } from "../parts/Card";
import { NAME } from "../parts/name";
import type { Purpose } from "./toolRecord";

interface NewToolProps {
  first: boolean;
  usedNames: readonly string[];
  busy: boolean;
  onBegin: (tool: string, purpose: Purpose, marker: string | null) => void;
}

/** Form for a tool: name and marker. */
export function NewTool({ first, usedNames, busy, onBegin }: NewToolProps): ReactNode {
  const texts = useTexts().tool;
  const [typed, setTyped] = useState<string | null>(null);
  const [chosen, setChosen] = useState<string | null>(null);
  const query = useQuery((signal) => getMarkers({ signal }), {
    everyMs: 3000,
  });
  const { data } = query;
  const markers = (data?.markers ?? []).map((one) => one.name);
  const marker = chosen !== null && markers.includes(chosen) ? chosen : (markers[0] ?? null);
  // The first tool usually has the name of its marker.
  const name = typed ?? (marker !== null && !usedNames.includes(marker) ? marker : "");
  const isNew = !usedNames.includes(name);
  const begin = (
    <Button
      size={first ? "xl" : "lg"}
      variant={first ? "filled" : "default"}
      disabled={busy || marker === null || !NAME.test(name) || !isNew}
      data-testid="begin-new"
      onClick={() => {
        onBegin(name, "pivot", marker);
      }}
    >
      {texts.begin.pivot}
    </Button>
  );
  return (
    <Card title={first ? texts.firstTitle : texts.newTitle} testId="new-tool">
      {first && <p className="card-lead">{texts.firstLead}</p>}
      {data === null ? (
        <QueryStatus query={query} />
      ) : markers.length === 0 ? (
        <p>
          {texts.noMarker}{" "}
          <Link className="way" href="/operator/camera">
            {texts.toMarkers}
          </Link>
        </p>
      ) : (
        <div className="row">
          <TextInput
            className="grow"
            size="lg"
            label={texts.name}
            description={texts.nameHint}
            value={name}
            error={name !== "" && !NAME.test(name) ? texts.nameWrong : isNew ? null : texts.nameTaken}
            onChange={(event) => {
              setTyped(event.currentTarget.value);
            }}
          />
          <Select
            className="grow"
            size="lg"
            label={texts.marker}
            description={texts.markerHint}
            allowDeselect={false}
            data={markers}
            value={marker}
            onChange={setChosen}
          />
          {!first && begin}
        </div>
      )}
      {first && markers.length > 0 && <StepActions>{begin}</StepActions>}
    </Card>
  );
}
