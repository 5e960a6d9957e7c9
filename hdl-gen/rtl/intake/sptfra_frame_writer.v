// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Frame writer of Bz: replaces dead taxels, shows stresses to CeAn, and writes them to the lanes as they are or folded.
//
// Stress to write: the same cycle, folded three cycles; with dead taxels see sptfra_replace.

`default_nettype none

module sptfra_frame_writer #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // 4: folded into parity classes; 1: as they are
    parameter WAYS = 4,
    // Bits of a stress, 27 at most, and of what the lanes read: as many, or 29 and more where taxels are folded
    parameter DATA_BITS = 27,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Places for dead taxels, 0 for none, and whether a calibration in RAM says which they are; else these
    parameter REPLACEABLE = 0,
    parameter MAPPED = 0,
    parameter [3:0] REPLACED_COUNT = 4'd0,
    parameter [4:0] REPLACED_SHIFT = 5'd17,
    parameter [16*((REPLACEABLE != 0) ? REPLACEABLE : 1)-1:0] REPLACED_TAXELS
        = {16*((REPLACEABLE != 0) ? REPLACEABLE : 1){1'b0}},
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = "",
    // Derived
    parameter ELEMENTS = (WAYS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3,
    parameter TAXELS = COLUMNS * ROWS,
    parameter TAXEL_WIDTH = (TAXELS > 2) ? $clog2(TAXELS) : 1,
    parameter PLACES = (REPLACEABLE != 0) ? REPLACEABLE : 1
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // Stresses
    input  wire in_valid,
    input  wire in_store, // a taxel of the frame, rather than what follows a frame that is too long
    input  wire in_last,
    input  wire in_bad_length,
    input  wire signed [26:0] in_stress,
    input  wire in_saturated,
    input  wire in_not_finite,
    // Dead taxels of a calibration in RAM: weights a cycle after their taxel is ahead, two stages before its stress
    input  wire [TAXEL_WIDTH-1:0] taxel_ahead,
    input  wire [18*PLACES-1:0] map_weights,
    input  wire [3:0] map_count,
    input  wire [4:0] map_shift,
    input  wire [16*PLACES-1:0] map_numbers,
    output wire busy, // a frame's last stress has come in and not gone out
    // Operand memories, class 0 in the lowest bits
    output wire write_valid,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [WAYS*DATA_BITS-1:0] write_data,
    // To CeAn: each stress, then the frame's flags
    output wire stress_valid,
    output wire signed [26:0] stress,
    output wire frame_done,
    output wire frame_saturated,
    output wire frame_not_finite,
    output wire frame_bad_length,
    output wire [29:0] frame_replaced, // sum of the magnitudes that took a dead taxel's place
    // Banks
    input  wire frame_opens, // a frame begins to come in
    output wire frame_ready, // a whole frame waits
    input  wire frame_start, // the lanes begin with it
    input  wire frame_release, // its bank is free again
    output wire bank_free
);

    localparam STRESS_BITS = (DATA_BITS < 27) ? DATA_BITS : 27;

    generate
        if ((WAYS != 1) && (WAYS != 4)) begin : gen_check_ways
            sptfra_error_ways_must_be_1_or_4 invalid ();
        end
        if ((DATA_BITS < 16) || (DATA_BITS > ((WAYS == 4) ? 35 : 27))) begin : gen_check_data
            sptfra_error_data_bits_must_be_16_to_27_or_to_35_where_taxels_are_folded invalid ();
        end
    endgenerate

    // ---- Dead taxels
    wire whole_valid, whole_store, whole_last;
    wire signed [26:0] fixed;
    wire saturated, not_finite;

    assign stress = fixed;

    generate
        if (REPLACEABLE != 0) begin : gen_replace
            wire [18*PLACES-1:0] weights;
            reg bad_length;

            if (MAPPED != 0) begin : gen_map
                assign weights = map_weights;
                wire _unused_ahead = &{1'b0, taxel_ahead, REPLACED_COUNT, REPLACED_SHIFT, REPLACED_TAXELS};
            end else begin : gen_neighbours
                sptfra_rom #(
                    .WIDTH         (18 * PLACES),
                    .DEPTH         (TAXELS),
                    .ADDRESS_WIDTH (TAXEL_WIDTH),
                    .ROM_DIR       (ROM_DIR),
                    .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_neighbours.mem"})
                ) neighbours (
                    .clock   (clock),
                    .enable  (advance),
                    .address (taxel_ahead),
                    .data    (weights)
                );

                wire _unused_map = &{1'b0, map_weights, map_count, map_shift, map_numbers};
            end

            assign whole_store = 1'b1;
            assign frame_bad_length = bad_length;

            always @(posedge clock) begin
                if (advance && in_valid && in_last) begin
                    bad_length <= in_bad_length;
                end
            end

            sptfra_replace #(
                .TAXELS       (TAXELS),
                .REPLACEABLE  (REPLACEABLE),
                .STRESS_BOUND (STRESS_BOUND)
            ) replace (
                .clock          (clock),
                .reset          (reset),
                .advance        (advance),
                .in_valid       (in_valid),
                .in_store       (in_store),
                .in_last        (in_last),
                .in_stress      (in_stress),
                .in_saturated   (in_saturated),
                .in_not_finite  (in_not_finite),
                .weights_ahead  (weights),
                .count          ((MAPPED != 0) ? map_count : REPLACED_COUNT),
                .weight_shift   ((MAPPED != 0) ? map_shift : REPLACED_SHIFT),
                .taxels         ((MAPPED != 0) ? map_numbers : REPLACED_TAXELS),
                .busy           (busy),
                .out_valid      (whole_valid),
                .out_last       (whole_last),
                .out_stress     (fixed),
                .out_saturated  (saturated),
                .out_not_finite (not_finite),
                .replaced       (frame_replaced)
            );
        end else begin : gen_as_read
            assign fixed = in_stress;
            assign saturated = in_saturated;
            assign not_finite = in_not_finite;
            assign whole_valid = in_valid;
            assign whole_store = in_store;
            assign whole_last = in_last;
            assign frame_bad_length = in_bad_length;
            assign busy = 1'b0;
            assign frame_replaced = 30'd0;
            wire _unused_map = &{1'b0, STRESS_BOUND, REPLACED_COUNT, REPLACED_SHIFT, REPLACED_TAXELS, ROM_DIR != "",
                ROM_NAME != "", MAPPED != 0, taxel_ahead, map_weights, map_count, map_shift, map_numbers};
        end
    endgenerate

    // ---- Write
    wire frame_written; // the frame is complete
    wire taxel_valid = whole_valid && whole_store;
    generate
        if (WAYS == 4) begin : gen_fold
            sptfra_fold #(
                .COLUMNS     (COLUMNS),
                .ROWS        (ROWS),
                .STRESS_BITS (STRESS_BITS),
                .DATA_BITS   (DATA_BITS)
            ) fold (
                .clock         (clock),
                .reset         (reset),
                .advance       (advance),
                .in_valid      (whole_valid),
                .in_store      (whole_store),
                .in_last       (whole_last),
                .in_stress     (fixed[STRESS_BITS-1:0]),
                .write_valid   (write_valid),
                .write_bank    (write_bank),
                .write_quad    (write_row),
                .write_data    (write_data),
                .frame_written (frame_written)
            );
        end else begin : gen_taxels
            reg bank;
            reg [ROW_WIDTH-1:0] taxel;

            assign write_valid = taxel_valid;
            assign write_bank = bank;
            assign write_row = taxel;
            assign write_data = fixed[STRESS_BITS-1:0];
            assign frame_written = frame_done;

            always @(posedge clock) begin
                if (stress_valid) begin
                    taxel <= taxel + 1;
                end
                if (frame_done) begin
                    bank <= !bank;
                    taxel <= {ROW_WIDTH{1'b0}};
                end
                if (reset) begin
                    bank <= 1'b0;
                    taxel <= {ROW_WIDTH{1'b0}};
                end
            end
        end
    endgenerate

    // ---- Tell CeAn
    reg seen_saturated;
    reg seen_not_finite;

    assign stress_valid = taxel_valid && advance;
    assign frame_done = whole_valid && whole_last && advance;
    assign frame_saturated = seen_saturated || (whole_store && saturated);
    assign frame_not_finite = seen_not_finite || (whole_store && not_finite);

    always @(posedge clock) begin
        if (stress_valid) begin
            seen_saturated <= frame_saturated;
            seen_not_finite <= frame_not_finite;
        end
        if (reset || frame_done) begin
            seen_saturated <= 1'b0;
            seen_not_finite <= 1'b0;
        end
    end

    // ---- Banks
    reg [1:0] banks_taken;
    reg [1:0] frames_waiting;

    assign bank_free = (banks_taken != 2'd2);
    assign frame_ready = (frames_waiting != 2'd0);

    always @(posedge clock) begin
        banks_taken <= banks_taken + {1'b0, frame_opens} - {1'b0, frame_release};
        frames_waiting <= frames_waiting + {1'b0, frame_written} - {1'b0, frame_start};
        if (reset) begin
            banks_taken <= 2'd0;
            frames_waiting <= 2'd0;
        end
    end

endmodule

`default_nettype wire
