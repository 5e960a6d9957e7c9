// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Corrections of a whole frame: replaces its dead taxels, then removes crosstalk, where the design has them.
//
// Without either a beat passes in the same cycle. Each keeps the frame until it is complete: see sptfra_replace and
// sptfra_crosstalk.

`default_nettype none

module sptfra_corrections #(
    // Taxels in x and y, and of a beat: one where something is corrected
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    parameter SAMPLES = 1,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Places for dead taxels, 0 for none: see sptfra_replace
    parameter REPLACEABLE = 0,
    parameter MAPPED = 0,
    parameter [3:0] REPLACED_COUNT = 4'd0,
    parameter [4:0] REPLACED_SHIFT = 5'd17,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)-1:0] REPLACED_TAXELS
        = {16*((REPLACEABLE != 0) ? REPLACEABLE : 1){1'b0}},
    // Fraction bits of the factors of crosstalk, 0 without any, and the factors: see sptfra_crosstalk
    parameter CROSSTALK = 0,
    parameter [53:0] CROSSTALK_FACTORS = 54'd0, // of rows, columns, frame
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
    output wire crosstalk_busy,
    // The same corrected
    output wire takes,
    output wire ends,
    output wire bad_length,
    output wire [27*SAMPLES-1:0] stresses,
    output wire [SAMPLES-1:0] saturated,
    output wire [SAMPLES-1:0] not_finite,
    output wire replaced // it took a dead taxel's place
);

    wire whole_takes, whole_ends, whole_bad_length, whole_replaced;
    wire [27*SAMPLES-1:0] whole_stresses;
    wire [SAMPLES-1:0] whole_saturated, whole_not_finite;

    generate
        if (REPLACEABLE != 0) begin : gen_replace
            sptfra_replace #(
                .TAXELS          (TAXELS),
                .REPLACEABLE     (REPLACEABLE),
                .MAPPED          (MAPPED),
                .REPLACED_COUNT  (REPLACED_COUNT),
                .REPLACED_SHIFT  (REPLACED_SHIFT),
                .REPLACED_TAXELS (REPLACED_TAXELS),
                .STRESS_BOUND    (STRESS_BOUND),
                .ROM_DIR         (ROM_DIR),
                .ROM_NAME        (ROM_NAME)
            ) replace (
                .clock          (clock),
                .reset          (reset),
                .in_takes       (in_takes),
                .in_ends        (in_ends),
                .in_bad_length  (in_bad_length),
                .in_stress      (in_stresses[26:0]),
                .in_saturated   (in_saturated[0]),
                .in_not_finite  (in_not_finite[0]),
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
            assign {whole_stresses, whole_saturated, whole_not_finite} = {in_stresses, in_saturated, in_not_finite};
            wire _unused_map = &{1'b0, REPLACED_COUNT, REPLACED_SHIFT, REPLACED_TAXELS, MAPPED != 0, ROM_DIR != "",
                ROM_NAME != "", taxel_ahead, map};
        end
        if (CROSSTALK != 0) begin : gen_crosstalk
            sptfra_crosstalk #(
                .COLUMNS       (COLUMNS),
                .ROWS          (ROWS),
                .ROW_FACTOR    (CROSSTALK_FACTORS[53:36]),
                .COLUMN_FACTOR (CROSSTALK_FACTORS[35:18]),
                .TOTAL_FACTOR  (CROSSTALK_FACTORS[17:0]),
                .FRACTION      (CROSSTALK),
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
                .out_takes      (takes),
                .out_ends       (ends),
                .out_bad_length (bad_length),
                .out_stress     (stresses[26:0]),
                .out_flags      ({saturated[0], not_finite[0], replaced})
            );
        end else begin : gen_without
            assign {takes, ends, bad_length, replaced, crosstalk_busy}
                = {whole_takes, whole_ends, whole_bad_length, whole_replaced, 1'b0};
            assign {stresses, saturated, not_finite} = {whole_stresses, whole_saturated, whole_not_finite};
            wire _unused_crosstalk = &{1'b0, CROSSTALK_FACTORS};
        end
        if ((REPLACEABLE == 0) && (CROSSTALK == 0)) begin : gen_neither
            wire _unused_neither = &{1'b0, clock, reset, STRESS_BOUND};
        end
    endgenerate

endmodule

`default_nettype wire
