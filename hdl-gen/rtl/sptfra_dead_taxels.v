// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Gives each dead taxel of a frame a weighted sum of the others in place of its own reading.
//
// A frame is kept while one accumulator for each dead taxel adds up its sum, then read again with the sums in their
// places. Last stress in to last stress out: TAXELS + 7 cycles; the next frame comes after that. A frame of a wrong
// length comes out with TAXELS stresses too, marked.

`default_nettype none

module sptfra_dead_taxels #(
    // Taxels of a frame
    parameter TAXELS = 100,
    // Dead ones among them, 1 to 8
    parameter DEAD = 1,
    // Fraction bits of the weights
    parameter WEIGHT_SHIFT = 16,
    // Full scale: what a larger sum becomes
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // Prefix of the ROM file names, and what they begin with
    parameter ROM_DIR = "",
    parameter ROM_NAME = ""
) (
    input  wire clock,
    input  wire reset,
    input  wire advance,
    // Stresses as they come
    input  wire in_valid,
    input  wire in_store, // a taxel of the frame, rather than what follows a frame that is too long
    input  wire in_last,
    input  wire in_bad_length,
    input  wire signed [26:0] in_stress,
    input  wire in_saturated,
    input  wire in_not_finite,
    // The frame again
    output wire busy, // from the last stress in to the last one out
    output wire out_valid,
    output wire out_last,
    output wire out_bad_length,
    output wire signed [26:0] out_stress,
    output wire out_saturated,
    output wire out_not_finite,
    output wire [29:0] replaced // sum of the magnitudes that took a reading's place, with the last stress
);

    localparam TAXEL_WIDTH = $clog2(TAXELS);
    localparam [31:0] LAST_WIDE = TAXELS - 1;
    localparam [TAXEL_WIDTH-1:0] LAST = LAST_WIDE[TAXEL_WIDTH-1:0];
    localparam signed [47:0] HALF = (48'sd1 <<< WEIGHT_SHIFT) >>> 1;
    localparam signed [47:0] MOST = {{21{STRESS_BOUND[26]}}, STRESS_BOUND};

    generate
        if ((DEAD < 1) || (DEAD > 8)) begin : gen_check_dead
            sptfra_error_dead_taxels_must_be_1_to_8 invalid ();
        end
    endgenerate

    // ---- Keep: the frame as it comes, then once more from its first taxel
    reg [TAXEL_WIDTH-1:0] taxel; // that comes, or that is read again
    reg keeps_1;
    reg first_1;
    reg last_1;
    reg signed [26:0] stress_1;
    reg [3:2] settles; // until the last product is in its sum
    reg replays;
    reg holds; // the sums are complete
    reg waits;
    reg bad_length;
    wire takes = in_valid && in_store;
    wire replays_last = replays && (taxel == LAST);

    assign busy = waits;

    always @(posedge clock) begin
        holds <= 1'b0;
        if (advance) begin
            keeps_1 <= takes;
            first_1 <= (taxel == {TAXEL_WIDTH{1'b0}});
            last_1 <= in_valid && in_last;
            stress_1 <= in_stress;
            settles <= {settles[2], last_1};
            if (takes || replays) begin
                taxel <= taxel + 1;
            end
            if (in_valid && in_last) begin
                waits <= 1'b1;
                bad_length <= in_bad_length;
            end
            if ((in_valid && in_last) || replays_last) begin
                taxel <= {TAXEL_WIDTH{1'b0}};
                replays <= 1'b0;
            end
            if (settles[3]) begin
                replays <= 1'b1;
                holds <= 1'b1;
            end
            if (out_valid && out_last) begin
                waits <= 1'b0;
            end
        end
        if (reset) begin
            taxel <= {TAXEL_WIDTH{1'b0}};
            keeps_1 <= 1'b0;
            last_1 <= 1'b0;
            settles <= 2'd0;
            replays <= 1'b0;
            waits <= 1'b0;
        end
    end

    wire signed [26:0] kept_stress;
    wire kept_saturated;
    wire kept_not_finite;

    sptfra_ram #(
        .WIDTH         (29),
        .DEPTH         (TAXELS),
        .ADDRESS_WIDTH (TAXEL_WIDTH)
    ) frame (
        .clock         (clock),
        .write_enable  (takes && advance),
        .write_address (taxel),
        .write_data    ({in_not_finite, in_saturated, in_stress}),
        .read_enable   (advance),
        .read_address  (taxel),
        .read_data     ({kept_not_finite, kept_saturated, kept_stress})
    );

    // ---- Weights: of the taxel in each sum, none of a dead one in any
    wire [18*DEAD-1:0] weights_1;
    wire [0:0] dead_1;

    sptfra_rom #(
        .WIDTH         (18 * DEAD),
        .DEPTH         (TAXELS),
        .ADDRESS_WIDTH (TAXEL_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_neighbours.mem"})
    ) weights (
        .clock   (clock),
        .enable  (advance),
        .address (taxel),
        .data    (weights_1)
    );

    sptfra_rom #(
        .WIDTH         (1),
        .DEPTH         (TAXELS),
        .ADDRESS_WIDTH (TAXEL_WIDTH),
        .ROM_DIR       (ROM_DIR),
        .FILE          ((ROM_NAME == "") ? "" : {ROM_NAME, "_dead.mem"})
    ) dead (
        .clock   (clock),
        .enable  (advance),
        .address (taxel),
        .data    (dead_1)
    );

    // ---- Sums, then the first of them that has not gone out
    wire [48*DEAD-1:0] sums;
    reg [48*DEAD-1:0] waiting;
    reg valid_1;
    genvar index;

    generate
        for (index = 0; index < DEAD; index = index + 1) begin : gen_sums
            sptfra_mac neighbours (
                .clock       (clock),
                .reset       (reset),
                .valid       (keeps_1 && advance),
                .first       (first_1),
                .coefficient ($signed(weights_1[18*index +: 18])),
                .data        (stress_1),
                .accumulator (sums[48*index +: 48])
            );
        end
    endgenerate

    always @(posedge clock) begin
        if (holds) begin
            waiting <= sums;
        end else if (advance && valid_1 && dead_1[0]) begin
            waiting <= waiting >> 48;
        end
    end

    // ---- Out: the sum rounded, then clipped, in place of what was read
    reg [4:2] valid;
    reg [4:1] lasts;
    reg [4:2] replaces;
    reg signed [47:0] sum_2;
    reg signed [47:0] sum_3;
    reg [28:0] read_2;
    reg [28:0] read_3;
    reg signed [26:0] stress_4;
    reg saturated_4;
    reg not_finite_4;
    reg [29:0] replaced_before; // without that of the stress that goes out
    wire above = (sum_3 > MOST);
    wire below = (sum_3 < -MOST);
    wire signed [26:0] clipped = above ? STRESS_BOUND : below ? -STRESS_BOUND : $signed(sum_3[26:0]);
    wire [26:0] magnitude = stress_4[26] ? -stress_4 : stress_4;

    assign out_valid = valid[4];
    assign out_last = lasts[4];
    assign out_bad_length = bad_length;
    assign out_stress = stress_4;
    assign out_saturated = saturated_4;
    assign out_not_finite = not_finite_4;
    assign replaced = replaced_before + (replaces[4] ? {3'd0, magnitude} : 30'd0);

    always @(posedge clock) begin
        if (advance) begin
            valid_1 <= replays;
            valid <= {valid[3:2], valid_1};
            lasts <= {lasts[3:1], replays_last};
            replaces <= {replaces[3:2], dead_1[0]};
            read_2 <= {kept_not_finite, kept_saturated, kept_stress};
            read_3 <= read_2;
            sum_2 <= $signed(waiting[47:0]);
            sum_3 <= (sum_2 + HALF) >>> WEIGHT_SHIFT;
            stress_4 <= !replaces[3] ? $signed(read_3[26:0]) : clipped;
            saturated_4 <= replaces[3] ? above || below : read_3[27];
            not_finite_4 <= !replaces[3] && read_3[28];
            if (valid[4]) begin
                replaced_before <= out_last ? 30'd0 : replaced;
            end
        end
        if (reset) begin
            valid_1 <= 1'b0;
            valid <= 3'd0;
            replaced_before <= 30'd0;
        end
    end

endmodule

`default_nettype wire
