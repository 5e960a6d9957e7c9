// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Corrections of a frame: replaces its dead taxels, then removes crosstalk, then creep, where the design has them.
//
// What fills a frame's last beat becomes zeros without flags. Without corrections a beat passes in the same cycle.
// sptfra_replace and sptfra_crosstalk keep the frame until it is complete; sptfra_creep takes 2 cycles.

`default_nettype none

module sptfra_frame_corrections #(
    // Taxels in x and y, and of a beat: one where something is corrected
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    parameter SAMPLES = 1,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Places for dead taxels, 0 for none: see sptfra_replace
    parameter REPLACEABLE = 0,
    parameter MAPPED = 0,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)+15:0] REPLACED = 0,
    // {fraction bits, factors of rows, columns and frame}, 0 without any: see sptfra_crosstalk
    parameter [59:0] CROSSTALK = 60'd0,
    // {strength, share}, 0 without any: see sptfra_creep
    parameter [45:0] CREEP = 46'd0,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter TAXELS = COLUMNS * ROWS,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter PLACES = (REPLACEABLE != 0) ? REPLACEABLE : 1
) (
    input  wire clock,
    input  wire reset,
    // Beats of stresses
    input  wire in_takes, // it is of the frame
    input  wire in_ends, // the frame ends with it, or with what follows a frame that is too long
    input  wire in_bad_length,
    input  wire [27*SAMPLES-1:0] in_stresses,
    input  wire [SAMPLES-1:0] in_saturated,
    input  wire [SAMPLES-1:0] in_not_finite,
    // Of dead taxels: see sptfra_replace
    input  wire [TAXEL_WIDTH-1:0] taxel_ahead,
    input  wire [34*PLACES+8:0] map,
    output wire replace_busy, // from a frame's last beat in to its last stress out
    output wire busy, // of crosstalk or creep
    // The same corrected
    output wire takes,
    output wire ends,
    output wire bad_length,
    output wire [27*SAMPLES-1:0] stresses,
    output wire [SAMPLES-1:0] saturated,
    output wire [SAMPLES-1:0] not_finite,
    output wire replaced // it took a dead taxel's place
);

    localparam BEATS = (TAXELS + SAMPLES - 1) / SAMPLES;
    localparam BEAT_WIDTH = (BEATS > 2) ? $clog2(BEATS) : 1;
    localparam REMAINDER = TAXELS - (BEATS - 1) * SAMPLES; // samples of the last beat
    localparam [31:0] REMAINDER_MASK = (1 << REMAINDER) - 1;
    localparam [31:0] LAST_BEAT = BEATS - 1;

    // ---- Samples of the frame
    reg [BEAT_WIDTH-1:0] beat;
    wire last_beat = (beat == LAST_BEAT[BEAT_WIDTH-1:0]);
    wire [SAMPLES-1:0] counted = last_beat ? REMAINDER_MASK[SAMPLES-1:0] : {SAMPLES{1'b1}};
    wire [27*SAMPLES-1:0] own_stresses;
    wire [SAMPLES-1:0] own_saturated = in_saturated & counted;
    wire [SAMPLES-1:0] own_not_finite = in_not_finite & counted;
    genvar sample;

    for (sample = 0; sample < SAMPLES; sample = sample + 1) begin : gen_samples
        assign own_stresses[27*sample +: 27] = counted[sample] ? in_stresses[27*sample +: 27] : 27'd0;
    end

    always @(posedge clock) begin
        if (in_takes) begin
            beat <= beat + 1'b1;
        end
        if (reset || in_ends) begin
            beat <= {BEAT_WIDTH{1'b0}};
        end
    end

    // ---- What is corrected
    wire whole_takes, whole_ends, whole_bad_length, whole_replaced;
    wire [27*SAMPLES-1:0] whole_stresses;
    wire [SAMPLES-1:0] whole_saturated, whole_not_finite;
    wire apart_takes, apart_ends, apart_bad_length, apart_replaced, crosstalk_busy, creep_busy; // without crosstalk
    wire [27*SAMPLES-1:0] apart_stresses;
    wire [SAMPLES-1:0] apart_saturated, apart_not_finite;

    assign busy = crosstalk_busy || creep_busy;

    if (REPLACEABLE != 0) begin : gen_replace
        sptfra_replace #(
            .TAXELS       (TAXELS),
            .REPLACEABLE  (REPLACEABLE),
            .MAPPED       (MAPPED),
            .REPLACED     (REPLACED),
            .STRESS_BOUND (STRESS_BOUND),
            .ROM_DIR      (ROM_DIR),
            .ROM_NAME     (ROM_NAME)
        ) replace (
            .clock          (clock),
            .reset          (reset),
            .in_takes       (in_takes),
            .in_ends        (in_ends),
            .in_bad_length  (in_bad_length),
            .in_stress      (own_stresses[26:0]),
            .in_saturated   (own_saturated[0]),
            .in_not_finite  (own_not_finite[0]),
            .taxel_ahead    (taxel_ahead),
            .map            (map),
            .busy           (replace_busy),
            .out_valid      (whole_takes),
            .out_last       (whole_ends),
            .out_bad_length (whole_bad_length),
            .out_stress     (whole_stresses[26:0]),
            .out_saturated  (whole_saturated[0]),
            .out_not_finite (whole_not_finite[0]),
            .out_replaced   (whole_replaced)
        );
    end else begin : gen_as_read
        assign {whole_takes, whole_ends, whole_bad_length, whole_replaced, replace_busy}
            = {in_takes, in_ends, in_bad_length, 2'b00};
        assign {whole_stresses, whole_saturated, whole_not_finite} = {own_stresses, own_saturated, own_not_finite};
        wire _unused_map = &{1'b0, REPLACED, MAPPED != 0, ROM_DIR != "", ROM_NAME != "", taxel_ahead, map};
    end
    if (CROSSTALK != 60'd0) begin : gen_crosstalk
        sptfra_crosstalk #(
            .COLUMNS       (COLUMNS),
            .ROWS          (ROWS),
            .ROW_FACTOR    (CROSSTALK[53:36]),
            .COLUMN_FACTOR (CROSSTALK[35:18]),
            .TOTAL_FACTOR  (CROSSTALK[17:0]),
            .FRACTION      (CROSSTALK[59:54]),
            .STRESS_BOUND  (STRESS_BOUND)
        ) crosstalk (
            .clock          (clock),
            .reset          (reset),
            .in_takes       (whole_takes),
            .in_ends        (whole_ends),
            .in_bad_length  (whole_bad_length),
            .in_stress      (whole_stresses[26:0]),
            .in_flags       ({whole_saturated[0], whole_not_finite[0], whole_replaced}),
            .busy           (crosstalk_busy),
            .out_takes      (apart_takes),
            .out_ends       (apart_ends),
            .out_bad_length (apart_bad_length),
            .out_stress     (apart_stresses[26:0]),
            .out_flags      ({apart_saturated[0], apart_not_finite[0], apart_replaced})
        );
    end else begin : gen_no_crosstalk
        assign {apart_takes, apart_ends, apart_bad_length, apart_replaced, crosstalk_busy}
            = {whole_takes, whole_ends, whole_bad_length, whole_replaced, 1'b0};
        assign {apart_stresses, apart_saturated, apart_not_finite}
            = {whole_stresses, whole_saturated, whole_not_finite};
    end
    if (CREEP != 46'd0) begin : gen_creep
        sptfra_creep #(
            .TAXELS       (TAXELS),
            .STRENGTH     (CREEP[45:23]),
            .SHARE        (CREEP[22:0]),
            .STRESS_BOUND (STRESS_BOUND)
        ) creep (
            .clock          (clock),
            .reset          (reset),
            .in_takes       (apart_takes),
            .in_ends        (apart_ends),
            .in_bad_length  (apart_bad_length),
            .in_stress      (apart_stresses[26:0]),
            .in_flags       ({apart_saturated[0], apart_not_finite[0], apart_replaced}),
            .busy           (creep_busy),
            .out_takes      (takes),
            .out_ends       (ends),
            .out_bad_length (bad_length),
            .out_stress     (stresses[26:0]),
            .out_flags      ({saturated[0], not_finite[0], replaced})
        );
    end else begin : gen_no_creep
        assign {takes, ends, bad_length, replaced, creep_busy}
            = {apart_takes, apart_ends, apart_bad_length, apart_replaced, 1'b0};
        assign {stresses, saturated, not_finite} = {apart_stresses, apart_saturated, apart_not_finite};
    end
    if ((REPLACEABLE == 0) && ({CROSSTALK, CREEP} == 0)) begin : gen_nothing
        wire _unused_nothing = &{1'b0, STRESS_BOUND};
    end

endmodule

`default_nettype wire
